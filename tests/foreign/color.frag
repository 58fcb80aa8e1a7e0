#version 460
// Colors a triangle by its normal, darker from behind.
layout(location = 0) in vec3 position;
layout(location = 0) out vec4 color;

void main() {
    vec3 n = cross(dFdx(position), dFdy(position));
    float length2 = dot(n, n);
    n = length2 > 0.0 ? abs(n) * inversesqrt(length2) : vec3(0.0);
    color = vec4(n * (gl_FrontFacing ? 1.0 : 0.5), 1.0);
}
