// ReportPictures of a program built without Vulkan: no pictures.

#include <CLI/CLI.hpp>

#include "app/report/pictures.h"

namespace lacedring::app {

struct ReportPictures::Drawer {
    bool off = false;
};

ReportPictures::ReportPictures() : drawer_(std::make_unique<Drawer>()) {}
ReportPictures::~ReportPictures() = default;

void ReportPictures::add_options(CLI::App& command) {
    command.add_flag("--no-gpu", drawer_->off, "draw no pictures");
}

Result<ReportPictures::Device> ReportPictures::open() {
    return Device{"", 0, "built without Vulkan"};
}

Result<void> ReportPictures::draw(const LoadedMesh&, const RingChoice&, MeshReport&) const {
    return {};
}

std::size_t ReportPictures::print_messages() const {
    return 0;
}

}  // namespace lacedring::app
