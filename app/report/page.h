#pragma once
// The page of `report`: one self-contained HTML document.

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "app/report/data.h"

namespace lacedring::app {

struct ReportPage {
    std::string command;  ///< the shell command that made the page
    std::string version;
    /// Name of the device that drew the pictures; empty: no pictures.
    std::string device;
    std::uint32_t samples = 0;  ///< per pixel
    std::span<const MeshReport> meshes;
    std::vector<std::pair<std::string, std::string>> left_out;  ///< meshes that failed, and why
};

std::string report_page(const ReportPage& page);

}  // namespace lacedring::app
