#include "app/formats/whole_file.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iterator>
#include <utility>

#include "app/cli/print.h"

namespace lacedring::app {

void add_attribute_bits(CLI::App& command, AttributeBits& bits) {
    add_position_bits(command, bits.positions);
    add_bits(command, "--normals", bits.normals, 2, 16, "round normals and tangents to two integers of {} bits");
    add_bits(command, "--texcoords", bits.texcoords, 1, 22, "round texture coordinates to {} bits");
    add_bits(command, "--colors", bits.colors, 1, 22, "round colors that are floats to {} bits");
    add_bits(command, "--weights", bits.weights, 1, 22, "round skin weights that are floats to {} bits");
}

bool quantizes(const AttributeBits& bits) {
    return std::max({bits.positions, bits.normals, bits.texcoords, bits.colors, bits.weights}) > 0;
}

Result<WholeFile> make_file(const Mesh& mesh, const Surface& surface, CornerTable table, const EncodeOptions& options,
                            const AttributeBits& bits, bool keep_order) {
    if (mesh.triangle_count() == table.topology.degenerate) {
        return Error{ErrorCode::malformed,
                     fmt::format("no triangle is left: all {} are degenerate", table.topology.degenerate)};
    }
    Result<Encoded> encoded = encode(std::move(table), options);
    if (!encoded) return encoded.error();
    Result<LrFile> file = make_lr_file(mesh, surface, std::move(*encoded), keep_order);
    if (!file) return file.error();
    WholeFile out{std::move(*file), {}, {}};
    // Attributes beside LR tables stay uncompressed: programs read such files in place.
    const bool streams = out.file.format == Format::lean || out.file.format == Format::packed;
    if (streams || quantizes(bits)) {
        AttributeBits threaded = bits;
        threaded.threads = options.threads;
        Result<std::vector<CompressedAttribute>> attributes = compress_attributes(out.file, threaded);
        if (!attributes) return attributes.error();
        out.attributes = std::move(*attributes);
    }
    out.bytes = serialize_lr(out.file);
    return out;
}

void note_lossless(RunLog& log, const std::string& input, const std::vector<CompressedAttribute>& attributes) {
    for (const CompressedAttribute& attribute : attributes) {
        if (attribute.exact.empty()) continue;
        log.note(input_name(input), fmt::format("{} stays lossless: {}", printable(attribute.name), attribute.exact));
    }
}

}  // namespace lacedring::app
