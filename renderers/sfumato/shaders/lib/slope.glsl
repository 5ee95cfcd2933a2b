// How a volume's surface is turned at a place, by its gradient. Needs volume.

uniform float u_edge;            // gradient (normalised value per mm) at which a place counts half as a surface

struct Slope {
    vec3 normal;                 // unit vector, world; zero where there is no gradient
    float surface;               // how much of a surface it is, 0 to 1
};

// Turned to the viewer, since a gradient has no outside; view is the unit vector towards the eye.
Slope slope_at(vec3 t, vec3 view) {
    vec3 normal = volume_gradient(t);
    float strength = length(normal);
    normal /= max(strength, 1e-20);
    if (dot(normal, view) < 0.0) normal = -normal;
    return Slope(normal, strength / (strength + u_edge));
}
