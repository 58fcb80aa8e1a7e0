#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/adjacency/adjacency_shared.h"

layout(binding = 0) uniform Frame { SilhouetteFrame frame; };
layout(location = 0) out vec4 out_color;

void main() { out_color = frame.color; }
