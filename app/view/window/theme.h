#pragma once
// Colours, sizes and fonts of the panels.

struct ImFont;

namespace lacedring::view {

/// Sizes are nominal pixels times `scale`.
void apply_theme(float scale);
/// Pixels of a nominal length.
float px(float nominal);
/// For what is read at leisure: legends.
ImFont* small_font();

}  // namespace lacedring::view
