#version 460
#extension GL_GOOGLE_include_directive : require
// Lines over the surface (ring, edges or seams), moved a little toward the eye.
#include "shaders/draw/line_vertex.glsl"

layout(location = 0) in vec3 in_position;

void main() { gl_Position = line_vertex(in_position); }
