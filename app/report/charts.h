#pragma once
// The charts of a report, as HTML and inline SVG: no script, and every number also stands in a table.

#include <span>
#include <string>

#include "app/report/data.h"

namespace lacedring::app {

/// Powers of two that bars of bits per triangle lie between: the same for all meshes of a page.
struct BitScale {
    int low = -1, high = 7;  ///< 0.5 to 128 at least
};
BitScale bit_scale(std::span<const MeshReport> meshes);

/// A bar a format, shortest first, on a logarithmic scale.
std::string bit_bars(const MeshReport& mesh, const BitScale& scale);

/// Section 6.1 and Figure 8 of the paper: a histogram a period, and the table of their numbers.
std::string offset_histograms(const MeshReport& mesh);

/// "ours", "paper", "baseline": the class that gives a format its color.
const char* class_of(Origin origin);

}  // namespace lacedring::app
