#include "renderer/draw/view.h"

#include <array>
#include <utility>

namespace lacedring::gpu {
namespace {

bool has_ring(View view) {
    return view == View::triangle_class || view == View::ring || view == View::offsets;
}

}  // namespace

bool has_lines(View view) {
    return has_ring(view) || view == View::wire || view == View::seams || view == View::silhouette;
}

std::optional<View> view_named(std::string_view name) {
    constexpr std::array<std::pair<std::string_view, View>, 9> kViews{{{"smooth", View::smooth},
                                                                       {"flat", View::flat},
                                                                       {"class", View::triangle_class},
                                                                       {"ring", View::ring},
                                                                       {"wire", View::wire},
                                                                       {"offsets", View::offsets},
                                                                       {"seams", View::seams},
                                                                       {"silhouette", View::silhouette},
                                                                       {"material", View::material}}};
    for (const auto& [text, view] : kViews) {
        if (text == name) return view;
    }
    return std::nullopt;
}

UploadOptions upload_options(View view) {
    UploadOptions options;
    options.ring = has_ring(view);
    options.offsets = view == View::offsets;
    if (options.ring) options.lines = UploadOptions::Lines::ring;
    if (view == View::wire) options.lines = UploadOptions::Lines::edges;
    if (view == View::seams) options.lines = UploadOptions::Lines::seams;
    return options;
}

}  // namespace lacedring::gpu
