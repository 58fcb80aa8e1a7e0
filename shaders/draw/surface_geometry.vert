#version 460
// A point for every LR_GEOMETRY_SLOTS slots: surface.geom does the rest (paper: LR 2011, section 7).
void main() {}
