// How a volume's surface is turned at a place, by its gradient. Needs volume.
// SOLID      cut faces are solid, and turned as their plane is

uniform float u_edge;            // gradient (normalised value per mm) at which a place counts half as a surface

struct Slope {
    vec3 normal;                 // unit vector, world; zero where there is no gradient
    float surface;               // how much of a surface it is, 0 to 1
};

#ifdef SOLID
vec3 g_face = vec3(0.0);         // normal of the cut face that is being shaded; zero within the volume
// Gradient by which a place is shaded: that of a cut face is as steep as can be.
vec3 shading_gradient(vec3 t) { return dot(g_face, g_face) > 0.0 ? 1e6 * u_edge * g_face : volume_gradient(t); }
#else
vec3 shading_gradient(vec3 t) { return volume_gradient(t); }
#endif

// Turned to the viewer, since a gradient has no outside; view is the unit vector towards the eye.
Slope slope_at(vec3 t, vec3 view) {
    vec3 normal = shading_gradient(t);
    float strength = length(normal);
    normal /= max(strength, 1e-20);
    if (dot(normal, view) < 0.0) normal = -normal;
    return Slope(normal, strength / (strength + u_edge));
}
