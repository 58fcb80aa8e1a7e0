#pragma once
// Colors, sizes and fonts of the panels.

struct ImFont;

namespace lacedring::view {

/// Sets fonts, colors and sizes, with `scale` pixels per nominal pixel.
void apply_theme(float scale);
/// Converts nominal pixels to pixels.
float px(float nominal);
/// The smaller font, for legends and details.
ImFont* small_font();

}  // namespace lacedring::view
