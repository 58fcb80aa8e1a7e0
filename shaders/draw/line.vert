#version 460
#extension GL_GOOGLE_include_directive : require
// The ring, or the edges of the triangles: over the surface, so a little nearer to the eye, along the same ray.
#include "shaders/draw/line_vertex.glsl"

layout(location = 0) in vec3 in_position;

void main() { gl_Position = line_vertex(in_position); }
