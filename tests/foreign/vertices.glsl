// Vertices read by the shader instead of input assembly.
layout(std430, binding = 1) readonly buffer Vertices { float vertices[]; };

vec3 vertex(uint v) { return vec3(vertices[3u * v], vertices[3u * v + 1u], vertices[3u * v + 2u]); }
