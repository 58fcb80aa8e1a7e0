#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared.h"

layout(binding = 0) uniform Frame { FrameConstants frame; };
layout(location = 0) out vec4 out_color;

void main() { out_color = frame.line_color; }
