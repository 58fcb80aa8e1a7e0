#version 460
// One point per LR_GEOMETRY_SLOTS slots; surface.geom does all the work (paper: LR 2011, section 7).
void main() {}
