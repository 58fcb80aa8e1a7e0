#pragma once
// Colours, sizes and fonts of the panels.

namespace lr::view {

/// Sizes are nominal pixels times `scale`.
void apply_theme(float scale);
/// Pixels of a nominal length.
float px(float nominal);

}  // namespace lr::view
