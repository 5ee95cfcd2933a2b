// Adds a frame to the sum of the frames before it (by blending).

uniform sampler2D u_frame;
layout(location = 0) out vec4 o_color;

void main() { o_color = texelFetch(u_frame, ivec2(gl_FragCoord.xy), 0); }
