#version 330 core
// A corner of a slice's section, in world space (mm), on its way to a picture.
in vec3 in_world;
uniform mat4 u_picture_from_world;

void main() { gl_Position = u_picture_from_world * vec4(in_world, 1.0); }
