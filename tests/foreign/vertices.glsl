// Vertices where no input assembly brings them.
layout(std430, binding = 1) readonly buffer Vertices { float vertices[]; };

vec3 vertex(uint v) { return vec3(vertices[3u * v], vertices[3u * v + 1u], vertices[3u * v + 2u]); }
