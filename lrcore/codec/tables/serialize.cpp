// Writes LR tables as words (docs/lr-tables.md).

#include "lacedring/lacedring.hpp"
#include "lrcore/base/signature.h"
#include "lrcore/codec/tables/stream_header.h"

namespace lacedring {
namespace {

template <class Table>
std::vector<std::uint32_t> serialize_tables(const Table& table, std::uint32_t magic_number, std::uint32_t unit,
                                            std::span<const VertexCopy> copies) {
    const auto size = [](const auto& v) { return static_cast<std::uint32_t>(v.size()); };
    std::vector<std::uint32_t> words = {magic_number,
                                        kLrVersion,
                                        table.vertices,
                                        table.ring_vertices,
                                        static_cast<std::uint32_t>(table.vo.size() / 6),
                                        size(table.star),
                                        size(table.c),
                                        static_cast<std::uint32_t>(copies.size()),
                                        unit,
                                        0};
    words.reserve(words.size() + table.lr.size() + table.vo.size() + table.star.size() + table.c.size() +
                  2 * copies.size());
    for (const auto* part : {&table.lr, &table.vo, &table.star, &table.c}) {
        words.insert(words.end(), part->begin(), part->end());
    }
    for (const VertexCopy& c : copies) words.insert(words.end(), {c.copy, c.original});
    words[kW_crc] = lr_checksum(words);
    return words;
}

}  // namespace

std::vector<std::uint32_t> serialize(const LrTable& table, std::span<const VertexCopy> copies) {
    return serialize_tables(table, magic::kLr, 0, copies);
}
std::vector<std::uint32_t> serialize(const CompactLrTable& table, std::span<const VertexCopy> copies) {
    return serialize_tables(table, magic::kCompactLr, table.unit, copies);
}

}  // namespace lacedring
