#version 460
#extension GL_GOOGLE_include_directive : require
// Like line.vert, but decodes each vertex from the vertex stream.
#include "shaders/draw/line_vertex.glsl"
#include "shaders/draw/vertex_source.glsl"

void main() { gl_Position = line_vertex(uintBitsToFloat(stream_position(stream_vertex(uint(gl_VertexIndex))))); }
