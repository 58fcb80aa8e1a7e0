#include "renderer/draw/view.h"

namespace lacedring::gpu {

bool has_ring(View view) {
    return view == View::triangle_class || view == View::ring || view == View::offsets;
}

bool has_lines(View view) {
    return has_ring(view) || view == View::wire || view == View::seams || view == View::silhouette;
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
