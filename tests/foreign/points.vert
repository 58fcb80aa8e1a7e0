#version 460
// One point per triangle; points.geom makes the triangle.
void main() { gl_Position = vec4(0.0, 0.0, 0.0, 1.0); }
