// Mutates seam sections so that they may stay valid: splits them into blocks (docs/seams-format.md), joins them again,
// and searches the length and the number of copies of each changed block.

#include <algorithm>
#include <bit>
#include <utility>

#include "lacedring/lacedring_seams.h"
#include "lrcore/base/crc32.h"
#include "lrcore/base/signature.h"
#include "tests/fuzz/streams.h"

namespace lacedring::fuzz {
namespace {

constexpr std::uint32_t kMostLength[] = {20, 20}, kMostCopies[] = {17, 11};  // bits of the directories' fields

struct Block {
    std::vector<bool> bits;
    std::uint32_t copies = 0;
};

/// Reads bits of words from a position; bits after the end are 0.
struct Bits {
    std::span<const std::uint32_t> words;
    std::size_t at;

    std::uint32_t take(std::uint32_t count) {
        std::uint32_t value = 0;
        for (std::uint32_t k = 0; k < count; ++k, ++at) {
            if (at / 32 < words.size()) value |= (words[at / 32] >> at % 32 & 1) << k;
        }
        return value;
    }
    std::size_t left() const { return 32 * words.size() - std::min(at, 32 * words.size()); }
};

class SeamSection {
  public:
    SeamSection(const Words& words, std::span<const std::uint32_t> triangles, std::uint32_t vertices)
        : triangles_(triangles), vertices_(vertices) {
        std::copy_n(words.begin(), 8, head_);
        Bits bits{words, 256};
        std::vector<std::uint32_t> lengths[2];
        for (std::uint32_t kind = 0; kind < 2; ++kind) {
            const std::size_t elements = kind == 0 ? vertices : triangles.size() / 3;
            blocks_[kind].resize((elements + LACEDRING_SEAMS_BLOCK - 1) / LACEDRING_SEAMS_BLOCK);
            for (std::size_t b = 0; b < blocks_[kind].size(); ++b) {
                if (b > 0 && b % LACEDRING_SEAMS_GROUP == 0) bits.at += 64;
                lengths[kind].push_back(bits.take(std::min(head_[3] >> 16 * kind & 255, kMostLength[kind])));
                blocks_[kind][b].copies = bits.take(std::min(head_[3] >> (16 * kind + 8) & 255, kMostCopies[kind]));
            }
        }
        for (std::uint32_t kind = 0; kind < 2; ++kind) {
            for (std::size_t b = 0; b < blocks_[kind].size(); ++b) {
                for (std::size_t k = std::min<std::size_t>(lengths[kind][b], bits.left()); k > 0; --k) {
                    blocks_[kind][b].bits.push_back(bits.take(1) != 0);
                }
            }
        }
    }

    /// The section, whose sizes, widths, directories and checksum fit the blocks.
    Words words() const {
        Words out(head_, head_ + 8);
        std::uint32_t widths = 0, homes = vertices_;
        for (std::uint32_t kind = 0; kind < 2; ++kind) {
            std::size_t length = 0;
            std::uint32_t copies = 0;
            for (const Block& block : blocks_[kind]) {
                length = std::max(length, block.bits.size());
                copies = std::max(copies, block.copies);
                if (kind == 0) homes += block.copies;
            }
            widths |= (static_cast<std::uint32_t>(std::bit_width(length)) |
                       static_cast<std::uint32_t>(std::bit_width(copies)) << 8)
                      << 16 * kind;
        }
        out[0] = magic::kSeams;
        out[2] = homes;
        out[3] = widths;
        std::size_t at = 256;
        const auto put = [&](std::uint64_t value, std::uint32_t count) {
            for (std::uint32_t k = 0; k < count; ++k, ++at) {
                if (at % 32 == 0) out.push_back(0);
                out.back() |= static_cast<std::uint32_t>(value >> k & 1) << at % 32;
            }
        };
        for (std::uint32_t kind = 0; kind < 2; ++kind) {
            std::uint64_t length = 0, copies = 0;
            for (std::size_t b = 0; b < blocks_[kind].size(); ++b) {
                if (b > 0 && b % LACEDRING_SEAMS_GROUP == 0) {
                    put(length, 32);
                    put(copies, 32);
                }
                const Block& block = blocks_[kind][b];
                put(block.bits.size(), widths >> 16 * kind & 255);
                put(block.copies, widths >> (16 * kind + 8) & 255);
                length += block.bits.size();
                copies += block.copies;
            }
        }
        for (const std::vector<Block>& blocks : blocks_) {
            for (const Block& block : blocks) {
                for (const bool bit : block.bits) put(bit ? 1 : 0, 1);
            }
        }
        out[1] = crc32(std::as_bytes(std::span(out).subspan(2)));
        return out;
    }

    /// Changes bits of a block or the table, or a block's number of copies.
    void mutate(Random& random) {
        if (random_below(random, 16) == 0) head_[4 + random_below(random, 4)] ^= 1U << random_below(random, 32);
        std::vector<Block>& blocks = blocks_[random_below(random, 4) == 0 ? 0 : 1];
        if (blocks.empty()) return;
        Block& block = blocks[random_below(random, blocks.size())];
        const std::size_t size = block.bits.size(), at = random_below(random, size + 1);
        const auto place = block.bits.begin() + static_cast<std::ptrdiff_t>(at);
        switch (size == 0 ? 2 : random_below(random, 6)) {
            case 0:
                block.copies += random_below(random, 3) - 1;
                return;
            case 1:
                block.bits.erase(block.bits.begin() + static_cast<std::ptrdiff_t>(at * (size - 1) / size));
                return;
            case 2:
                block.bits.insert(place, random_below(random, 2) != 0);
                return;
            default:
                for (std::uint32_t n = random_below(random, 3) + 1; n > 0; --n) {
                    block.bits[random_below(random, size)].flip();
                }
        }
    }

    /// Searches a length and a number of copies that make the first invalid block valid; continues with the next.
    void mend() {
        int tries = 300;
        for (Place wrong = first_wrong(); wrong < kAllRight;) {
            const Place before = wrong;
            Block& block = blocks_[wrong.first][wrong.second];
            const Block old = block;
            for (int change = 0; change < 7 * 33 && wrong <= before; ++change) {
                const int copies = signed_of(change % 7), length = signed_of(change / 7);
                block = old;
                block.copies += static_cast<std::uint32_t>(copies);
                if (block.copies > old.copies + 3 ||
                    (length < 0 && old.bits.size() < static_cast<std::size_t>(-length))) {
                    continue;
                }
                block.bits.resize(old.bits.size() + static_cast<std::size_t>(length));
                if (--tries < 0) return;
                wrong = first_wrong();
            }
            if (wrong <= before) return;
        }
    }

  private:
    using Place = std::pair<std::uint32_t, std::uint64_t>;  ///< kind and number of a block
    static constexpr Place kAllRight{2, 0};

    /// 0, 1, -1, 2, -2, ...
    static int signed_of(int n) { return n % 2 == 0 ? -n / 2 : (n + 1) / 2; }

    /// The position of the first error, whether or not it can be mended.
    Place first_wrong() const {
        const Words section = words();
        const auto triangles = static_cast<std::uint32_t>(triangles_.size() / 3);
        lacedring_seams seams;
        if (lacedring_seams_open(section.data(), section.size(), vertices_, triangles, &seams, nullptr) !=
            LACEDRING_STATUS_OK) {
            return kAllRight;
        }
        Words scratch(lacedring_seams_scratch(&seams));
        std::uint64_t where = 0;
        const lacedring_status status = lacedring_seams_check(&seams, triangles_.data(), scratch.data(), &where);
        if (status == LACEDRING_STATUS_VERTEX_BLOCK && where < blocks_[0].size()) return {0, where};
        if (status == LACEDRING_STATUS_BLOCK && where < blocks_[1].size()) return {1, where};
        return kAllRight;
    }

    std::uint32_t head_[8];
    std::vector<Block> blocks_[2];
    std::span<const std::uint32_t> triangles_;
    std::uint32_t vertices_;
};

}  // namespace

void mutate_seams(Words& section, std::span<const std::uint32_t> triangles, std::uint32_t vertices, Random& random) {
    constexpr std::size_t most_words = 1000, most_triangles = 600, most_vertices = 4096;
    if (section.size() < LACEDRING_SEAMS_HEADER_WORDS || section.size() > most_words ||
        triangles.size() > 3 * most_triangles || vertices > most_vertices) {
        return;
    }
    SeamSection parts(section, triangles, vertices);
    parts.mutate(random);
    if (random_below(random, 8) != 0) parts.mend();
    section = parts.words();
}

}  // namespace lacedring::fuzz
