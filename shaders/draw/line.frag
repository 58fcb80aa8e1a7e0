#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared.h"

layout(binding = 0) uniform Frame { FrameConstants frame; };
layout(location = 0) out vec4 out_colour;

void main() { out_colour = frame.line_colour; }
