// Compresses the attributes of an .lr file to vertex streams.

#include <algorithm>
#include <iterator>

#include "lacedring/lr_file.hpp"

namespace lacedring {
namespace {

/// The quantization bits of the attribute called `name`; 0: lossless.
std::uint32_t bits_for(std::string_view name, const AttributeBits& bits) {
    if (name == "POSITION") return bits.positions;
    if (name == "NORMAL" || name == "TANGENT") return bits.normals;
    if (name.starts_with("TEXCOORD_")) return bits.texcoords;
    if (name.starts_with("COLOR_")) return bits.colors;
    if (name.starts_with("WEIGHTS_")) return bits.weights;
    return 0;
}

}  // namespace

VertexOptions vertex_options(const Attribute& attribute, const AttributeBits& bits) {
    VertexOptions options;
    options.threads = bits.threads;
    const std::uint32_t wanted = bits_for(attribute.name, bits);
    const float step = attribute.name == "POSITION" ? bits.position_step : 0;
    const bool floats = attribute.type == ComponentType::f32 || attribute.type == ComponentType::f64;
    if (!floats || (wanted == 0 && !(step > 0))) return options;
    const bool direction = attribute.name == "NORMAL" || attribute.name == "TANGENT";
    options.mapping = direction ? VertexMapping::octahedral : VertexMapping::lattice;
    options.bits = wanted;
    options.step = step;
    return options;
}

Result<std::vector<CompressedAttribute>> compress_attributes(LrFile& file, const AttributeBits& bits) {
    const std::uint32_t lattices[] = {bits.positions, bits.texcoords, bits.colors, bits.weights};
    if (*std::max_element(std::begin(lattices), std::end(lattices)) > 22 || bits.normals == 1 || bits.normals > 16) {
        return Error{ErrorCode::invalid_argument, "1 to 22 bits a component, and 2 to 16 of normals"};
    }
    std::vector<CompressedAttribute> out;
    for (LrAttribute& attribute : file.attributes) {
        if (!attribute.words.empty()) continue;
        CompressedAttribute report{attribute.name, attribute.data.size(), attribute.data.size(), 0, {}};
        const VertexValues values{attribute.type, attribute.components, attribute.normalized, attribute.data};
        VertexOptions options = vertex_options(attribute, bits);
        const bool wanted =
            bits_for(attribute.name, bits) > 0 || (attribute.name == "POSITION" && bits.position_step > 0);
        const bool exact = options.mapping == VertexMapping::floats;
        if (wanted && exact) report.exact = "its values are integers";
        Result<EncodedVertices> encoded = encode_vertices(values, options);
        if (!exact && !encoded && encoded.error().code == ErrorCode::invalid_argument) {
            report.exact = encoded.error().message;
            options.mapping = VertexMapping::floats;
            encoded = encode_vertices(values, options);
        }
        if (encoded) {
            report.largest_error = encoded->largest_error;
            report.bytes = 4 * encoded->words.size();
            attribute.words = std::move(encoded->words);
            attribute.data = {};
            if (const Result<VertexView> view = view_vertices(attribute.words)) {
                attribute.type = view->type;
                if (wanted && view->mapping == VertexMapping::decimals) report.exact = "that is smaller";
            }
        } else if (encoded.error().code != ErrorCode::invalid_argument) {
            return encoded.error();
        }
        out.push_back(std::move(report));
    }
    return out;
}

}  // namespace lacedring
