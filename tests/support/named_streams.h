#pragma once
// Streams of all formats, for tests that must hold for each.

#include <doctest/doctest.h>

#include "lacedring/lacedring.hpp"
#include "tests/support/capture.h"
#include "tests/support/meshes.h"

namespace lacedring::test {

/// Encodes each named mesh of at most 1000 triangles in every format that can, and calls use(StreamView).
template <class Use>
void for_each_named_stream(Use use) {
    for (const NamedMesh& named : named_meshes()) {
        if (named.mesh.triangle_count() > 1000) continue;
        CAPTURE(named.name);
        for (const Format format : {Format::lean, Format::packed, Format::lr, Format::lr_compact}) {
            CAPTURE(name_of(format));
            const Result<Encoded> encoded =
                encode(named.mesh.indices, named.mesh.vertex_count, {.format = format, .effort = 0});
            if (!encoded) continue;
            const Result<StreamView> view = validate(encoded->words);
            REQUIRE_MESSAGE(view, view.error().message);
            use(*view);
        }
    }
}

}  // namespace lacedring::test
