// View rays. A pixel's ray is p(z) = origin + direction * z, with z the view depth in mm (not the distance).

uniform vec3 u_eye;          // world, mm
uniform vec3 u_right;        // camera basis, world
uniform vec3 u_up;
uniform vec3 u_forward;
uniform vec2 u_half;         // half extent of the picture: mm (orthographic) or tangents (perspective)
uniform vec2 u_center;       // window centre in half extents, as in VTK
uniform bool u_parallel;
uniform vec2 u_size;         // pixels of the whole picture
uniform vec2 u_corner;       // pixels from its lower left corner to that of the part that is drawn
uniform vec2 u_pixel_jitter; // pixels

struct Ray {
    vec3 origin;      // world, mm
    vec3 direction;   // world, per mm of depth; its length is the secant of the ray against the view axis
    vec2 lateral0;    // position across the view axis in mm: lateral0 + lateral1 * z
    vec2 lateral1;
};

Ray view_ray(vec2 pixel) {
    // The corner first, which is exact: so a tile's rays are those of the whole picture to the last bit.
    vec2 ndc = (pixel + u_corner + u_pixel_jitter) / u_size * 2.0 - 1.0;
    vec2 across = (ndc + u_center) * u_half;
    vec3 offset = u_right * across.x + u_up * across.y;
    if (u_parallel) return Ray(u_eye + offset, u_forward, across, vec2(0.0));
    return Ray(u_eye, u_forward + offset, vec2(0.0), across);
}
