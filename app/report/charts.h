#pragma once
// The charts of a report, as HTML and inline SVG without scripts. Every number is also in a table.

#include <span>
#include <string>

#include "app/report/data.h"

namespace lacedring::app {

/// Range of the logarithmic axis of bits per triangle, as exponents of two; the same for all meshes of a page.
struct BitScale {
    int low = -1, high = 7;  ///< at least 0.5 to 128 bits
};
BitScale bit_scale(std::span<const MeshReport> meshes);

/// One bar per format, shortest first.
std::string bit_bars(const MeshReport& mesh, const BitScale& scale);

/// A histogram of the offsets along the ring for each k of Figure 8 (RingOptions::k; 0: depth first), and a table of
/// the same counts. Paper: section 6.1, Figure 8.
std::string offset_histograms(const MeshReport& mesh);

/// The CSS class that colors a format: "ours", "paper" or "baseline".
const char* class_of(Origin origin);

}  // namespace lacedring::app
