#version 460
// Vertices from input assembly, for the plain index list and the one of expand.comp.
layout(push_constant) uniform Push { mat4 camera; };
layout(location = 0) in vec3 vertex;
layout(location = 0) out vec3 position;

void main() {
    position = vertex;
    gl_Position = camera * vec4(position, 1.0);
}
