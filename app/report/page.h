#pragma once
// The page of `report`: one HTML document that needs nothing beside itself.

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "app/report/data.h"

namespace lacedring::app {

struct ReportPage {
    std::string command;  ///< as it could be run again
    std::string version;
    std::string device;         ///< that drew; empty if none did
    std::uint32_t samples = 0;  ///< a pixel
    std::span<const MeshReport> meshes;
    std::vector<std::pair<std::string, std::string>> left_out;  ///< meshes that failed, and why
};

std::string report_page(const ReportPage& page);

}  // namespace lacedring::app
