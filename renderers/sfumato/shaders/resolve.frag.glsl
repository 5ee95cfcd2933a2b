// From accumulated light to the picture: mean of the frames, exposure and white balance, tone curve, sRGB, straight
// alpha, row 0 on top.

uniform sampler2D u_sum;
uniform sampler2D u_unshadowed;  // the same frames without shadows
uniform float u_floor;       // least share of that
uniform float u_scale;       // 1 / frames
uniform mat3 u_to_white;     // exposure and white balance
uniform bool u_soft;         // bend what is bright, instead of clipping it
uniform vec4 u_background;   // linear, premultiplied

layout(location = 0) out vec4 o_color;

vec3 srgb(vec3 linear) {
    return mix(linear * 12.92, 1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055, greaterThan(linear, vec3(0.0031308)));
}

// From the knee on, light comes ever nearer to white.
vec3 bent(vec3 light) {
    const float knee = 0.6;
    return mix(light, 1.0 - (1.0 - knee) * exp(-(max(light, knee) - knee) / (1.0 - knee)), greaterThan(light, vec3(knee)));
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    at.y = textureSize(u_sum, 0).y - 1 - at.y;
    vec4 light = texelFetch(u_sum, at, 0) * u_scale;
    if (u_floor > 0.0) light.rgb = max(light.rgb, u_floor * u_scale * texelFetch(u_unshadowed, at, 0).rgb);
    light += (1.0 - light.a) * u_background;
    vec3 straight = light.a > 0.0 ? light.rgb / light.a : vec3(0.0);
    straight = u_to_white * straight;
    if (u_soft) straight = bent(straight);
    o_color = vec4(srgb(clamp(straight, 0.0, 1.0)), light.a);
}
