#include "lrcore/codec/vertices/vertex_layout.h"

#include <algorithm>
#include <bit>

#include "lacedring/lacedring_vertices.h"
#include "lrcore/base/crc32.h"
#include "lrcore/base/signature.h"

namespace lacedring {
namespace {

constexpr std::size_t kChecksum = 3;  // word of the header

std::uint64_t table_word(const VertexStreamParts& parts) {
    return LACEDRING_VERTICES_HEADER_WORDS + 2 * parts.components.size() + parts.exceptions.size();
}
std::size_t group_words(const VertexStreamParts& parts) {
    return 1 + ((kVertexGroup - 1) * parts.field_bits() + 31) / 32;
}

}  // namespace

void find_vertex_ranges(std::span<const std::uint32_t> values, VertexMapping mapping,
                        std::span<VertexComponent> components) {
    const bool is_signed = mapping != VertexMapping::floats && mapping != VertexMapping::doubles;
    const std::uint32_t flip = is_signed ? 0x80000000U : 0;
    for (std::size_t c = 0; c < components.size() && !values.empty(); ++c) {
        std::uint32_t low = UINT32_MAX, high = 0;
        for (std::size_t i = c; i < values.size(); i += components.size()) {
            low = std::min(low, values[i] ^ flip);
            high = std::max(high, values[i] ^ flip);
        }
        components[c].low = low ^ flip;
        components[c].first_bits = static_cast<std::uint32_t>(std::bit_width(high - low));
    }
}

std::uint64_t VertexStreamParts::size() const {
    const std::size_t groups = (begins.size() + kVertexGroup - 1) / kVertexGroup;
    return table_word(*this) + group_words(*this) * groups + data.size() + 2;
}

std::vector<std::uint32_t> make_vertex_stream(const VertexStreamParts& parts) {
    const std::uint32_t field = parts.field_bits();
    const std::size_t table = static_cast<std::size_t>(table_word(parts)), group = group_words(parts);
    std::vector<std::uint32_t> out;
    out.reserve(static_cast<std::size_t>(parts.size()));
    out = {magic::kVertices,
           parts.vertices,
           parts.layout,
           0,
           parts.parameter,
           parts.largest_error,
           static_cast<std::uint32_t>(parts.exceptions.size() / 2)};
    for (const VertexComponent& c : parts.components) {
        out.push_back(c.low);
        out.push_back(c.first_bits | c.width << 6 | c.predictor << 11);
    }
    out.insert(out.end(), parts.exceptions.begin(), parts.exceptions.end());
    out.resize(table + group * ((parts.begins.size() + kVertexGroup - 1) / kVertexGroup), 0);
    for (std::size_t b = 0; b < parts.begins.size(); ++b) {
        const std::size_t k = b % kVertexGroup;
        std::uint32_t* at = out.data() + table + b / kVertexGroup * group;
        if (k == 0) {
            at[0] = static_cast<std::uint32_t>(parts.begins[b] / 32);
            continue;
        }
        const std::uint64_t distance = parts.begins[b] - parts.begins[b - k];
        const std::size_t bit = (k - 1) * field;
        at[1 + bit / 32] |= static_cast<std::uint32_t>(distance << bit % 32);
        if (bit % 32 + field > 32) at[2 + bit / 32] |= static_cast<std::uint32_t>(distance >> (32 - bit % 32));
    }
    out.insert(out.end(), parts.data.begin(), parts.data.end());
    out.insert(out.end(), {0, 0});  // padding, so that 64-bit loads stay within the stream
    const std::uint32_t header = crc32(std::as_bytes(std::span(out).first(kChecksum)));
    out[kChecksum] = crc32(std::as_bytes(std::span(out).subspan(kChecksum + 1)), header);
    return out;
}

}  // namespace lacedring
