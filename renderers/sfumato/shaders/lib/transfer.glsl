// Classification. Needs volume. Pre-integrated (Engel2001) with one-dimensional integral functions: the mean of the extinction
// over values s0..s1 is (I(s1) - I(s0)) / (s1 - s0), so that thin shells between two samples are not missed.

uniform float u_table_size;          // entries of the tables

#ifdef TRANSFER_2D
uniform sampler2D u_table2d;         // integral of (tau * colour, tau) over the normalised value, a row a gradient magnitude
uniform sampler2D u_emission2d;      // the same of tau * emission
uniform float u_gradient_scale;      // 1 / the gradient magnitude (normalised value per mm) at the last row

// The values are rounded to the table's entries, as those of one-dimensional functions are; rows are interpolated.
vec4 integral_slope(sampler2D table, float s0, float s1, float gradient) {
    float last = u_table_size - 1.0, rows = float(textureSize(table, 0).y);
    float k0 = floor(s0 * last + 0.5), k1 = floor(s1 * last + 0.5);
    if (k0 == k1) { k0 = max(k0 - 1.0, 0.0); k1 = min(k1 + 1.0, last); }
    float row = (sqrt(clamp(gradient * u_gradient_scale, 0.0, 1.0)) * (rows - 1.0) + 0.5) / rows;
    vec4 change = textureLod(table, vec2((k1 + 0.5) / u_table_size, row), 0.0)
        - textureLod(table, vec2((k0 + 0.5) / u_table_size, row), 0.0);
    return max(change * (last / (k1 - k0)), 0.0);
}
// Mean extinction per mm (a) and extinction times colour (rgb) between two values.
vec4 classify(float s0, float s1, float gradient) { return integral_slope(u_table2d, s0, s1, gradient); }
vec3 classify_emission(float s0, float s1, float gradient) { return integral_slope(u_emission2d, s0, s1, gradient).rgb; }

uniform sampler2D u_extinction;      // how many of the table's entries, up to each, are seen at any gradient

// Whether anything between two values is seen, whatever its gradient.
bool is_seen(float s0, float s1) {
    float last = u_table_size - 1.0;
    int k0 = int(min(s0, s1) * last + 0.5) - 1, k1 = min(int(max(s0, s1) * last + 0.5) + 1, int(last));
    float below = k0 > 0 ? texelFetch(u_extinction, ivec2(k0 - 1, 0), 0).r : 0.0;
    return texelFetch(u_extinction, ivec2(k1, 0), 0).r > below;
}
// Gradient magnitude at a place between two values; 0 where none is seen: it costs six samples of the volume.
float steepness(float s0, float s1, vec3 t) { return is_seen(s0, s1) ? length(volume_gradient(t)) : 0.0; }
// Mean extinction per mm between two values, around a place.
float extinction_around(float s0, float s1, vec3 t) {
    return is_seen(s0, s1) ? classify(s0, s1, length(volume_gradient(t))).a : 0.0;
}
#else
uniform sampler2D u_integral;        // integral of (tau * colour, tau) over the normalised value
uniform sampler2D u_emission;        // integral of tau * emission

// The values are rounded to the table's entries: its differences are exact there, and linear interpolation of four
// channels costs a software renderer four times as much.
vec4 integral_slope(sampler2D table, float s0, float s1) {
    int k0 = int(s0 * (u_table_size - 1.0) + 0.5), k1 = int(s1 * (u_table_size - 1.0) + 0.5);
    if (k0 == k1) { k0 = max(k0 - 1, 0); k1 = min(k1 + 1, int(u_table_size) - 1); }
    vec4 change = texelFetch(table, ivec2(k1, 0), 0) - texelFetch(table, ivec2(k0, 0), 0);
    return change * ((u_table_size - 1.0) / float(k1 - k0));
}
vec4 classify(float s0, float s1, float gradient) { return max(integral_slope(u_integral, s0, s1), 0.0); }

uniform sampler2D u_extinction;      // integral of tau alone

// Mean extinction per mm between two values that are rounded to the table's entries: cheap, for what casts shadows.
float classify_extinction(float s0, float s1) {
    int k0 = int(s0 * (u_table_size - 1.0) + 0.5), k1 = int(s1 * (u_table_size - 1.0) + 0.5);
    if (k0 == k1) { k0 = max(k0 - 1, 0); k1 = min(k1 + 1, int(u_table_size) - 1); }
    float change = texelFetch(u_extinction, ivec2(k1, 0), 0).r - texelFetch(u_extinction, ivec2(k0, 0), 0).r;
    return change / (float(k1 - k0) / (u_table_size - 1.0));
}
float steepness(float s0, float s1, vec3 t) { return 0.0; }
float extinction_around(float s0, float s1, vec3 t) { return classify_extinction(s0, s1); }
vec3 classify_emission(float s0, float s1, float gradient) { return max(integral_slope(u_emission, s0, s1).rgb, 0.0); }
#endif
