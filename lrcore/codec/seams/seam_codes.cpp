#include "lrcore/codec/seams/seam_codes.h"

#include <algorithm>
#include <limits>

#include "lrcore/base/crc32.h"
#include "lrcore/base/signature.h"
#include "lrcore/codec/bit_writer.h"

namespace lacedring {
namespace {

constexpr std::uint32_t kNoRun = UINT32_MAX;
constexpr std::uint32_t kClasses = 8;  // number of classes of runs
constexpr std::uint32_t kRare = 7;     // the class with an exponential Golomb code
// Blocks of vertices, and of triangles, sampled to choose the table.
constexpr std::uint32_t kSampledBlocks = 64;

std::uint32_t run_bits(std::uint32_t run, std::uint32_t k) {
    return k == kRare ? 1 + BitWriter::golomb_bits(run, 5) : (run >> (k - 1)) + k;
}

/// The run written for a block's last `run` likely values: the longest run with a code of the same size. kRare has an
/// "endless" code instead.
std::uint32_t last_run(std::uint32_t run, std::uint32_t k) {
    return run | ((1U << (k - 1)) - 1);
}

/// Finds the codes of a block: calls code(i, class, run, last) for each run, which is written before answer
/// i. Returns the total bits. Sets `end` to the first answer from which on a reader infers all codes.
template <class Code>
std::uint64_t find_codes(std::span<const SeamAnswer> answers, const SeamTable& table, std::size_t& end, Code code) {
    struct Run {
        std::uint32_t length = 0;
        std::size_t place = 0;
        // Likely answers of class 0 before the run, which a reader could infer at the block's end.
        std::uint64_t single = 0;
    };
    Run runs[kClasses];
    std::uint64_t bits = 0, single = 0, single_before_end = 0;
    end = 0;
    const auto extend = [&](std::size_t place, std::uint64_t before) {
        if (place < end) return;
        end = place + 1;
        single_before_end = before;
    };
    for (std::size_t i = 0; i < answers.size(); ++i) {
        const SeamAnswer& answer = answers[i];
        if (answer.context == kSeamContexts) {
            bits += answer.bits;
            extend(i, single);
            continue;
        }
        const std::uint32_t k = table.run_class[answer.context];
        const bool likely = answer.value == table.likely[answer.context];
        if (k == 0) {
            if (likely) {
                ++single;
            } else {
                ++bits;
                extend(i, single);
            }
            continue;
        }
        Run& run = runs[k];
        if (run.length == 0) {
            run.place = i;
            run.single = single;
        }
        if (likely) {
            ++run.length;
            continue;
        }
        bits += run_bits(run.length, k);
        extend(run.place, run.single);
        code(run.place, k, run.length, false);
        run.length = 0;
    }
    for (std::uint32_t k = 1; k < kClasses; ++k) {
        if (runs[k].length == 0 || runs[k].place >= end) continue;
        bits += k == kRare ? 1 : run_bits(last_run(runs[k].length, k), k);
        code(runs[k].place, k, runs[k].length, true);
    }
    return bits + single_before_end;
}

/// Chooses the table: first the best class of each context by itself; then merges classes and moves contexts while this
/// saves bits.
class TableSearch {
  public:
    TableSearch(const SeamAnswers& vertices, const SeamAnswers& corners) {
        for (const SeamAnswers* answers : {&vertices, &corners}) {
            const std::size_t blocks = answers->begin.size();
            const std::size_t step = (blocks + kSampledBlocks - 1) / kSampledBlocks;
            for (std::size_t b = 0; b < blocks; b += step) blocks_.push_back(answers->block(b));
        }
    }

    SeamTable best() {
        Counts counts{};
        for (const auto& block : blocks_) {
            for (const SeamAnswer& answer : block) {
                if (answer.context < kSeamContexts) ++counts[answer.context][answer.value];
            }
        }
        for (std::uint32_t c = 0; c < kSeamContexts; ++c) table_.likely[c] = counts[c][1] > counts[c][0] ? 1 : 0;
        SeamTable best = table_;
        std::uint64_t least = std::numeric_limits<std::uint64_t>::max();
        for (const bool with_ends : {false, true}) {
            choose_alone(counts, with_ends);
            improve(counts);
            if (bits_ >= least) continue;
            least = bits_;
            best = table_;
        }
        return best;
    }

  private:
    using Counts = std::array<std::array<std::uint64_t, 2>, kSeamContexts>;

    /// Chooses the best class of each context by itself. `with_ends`: also count the codes of runs that end with their
    /// block.
    void choose_alone(const Counts& counts, bool with_ends) {
        std::array<std::array<std::uint64_t, kClasses>, kSeamContexts> bits{};
        std::array<std::uint32_t, kSeamContexts> run{};
        for (const auto& block : blocks_) {
            for (const SeamAnswer& answer : block) {
                if (answer.context == kSeamContexts) continue;
                if (answer.value == table_.likely[answer.context]) {
                    ++run[answer.context];
                    continue;
                }
                for (std::uint32_t k = 1; k < kClasses; ++k) {
                    bits[answer.context][k] += run_bits(run[answer.context], k);
                }
                run[answer.context] = 0;
            }
            for (std::uint32_t c = 0; c < kSeamContexts; ++c) {
                for (std::uint32_t k = 1; k < kClasses && with_ends && run[c] > 0; ++k) {
                    bits[c][k] += k == kRare ? 1 : run_bits(last_run(run[c], k), k);
                }
                if (with_ends) run[c] = 0;
            }
        }
        for (std::uint32_t c = 0; c < kSeamContexts; ++c) {
            bits[c][0] = counts[c][0] + counts[c][1];
            table_.run_class[c] = static_cast<std::uint8_t>(std::ranges::min_element(bits[c]) - bits[c].begin());
        }
    }

    void improve(const Counts& counts) {
        bits_ = size(table_);
        for (bool better = true; better;) {
            better = false;
            while (join_classes()) better = true;
            for (std::uint32_t c = 0; c < kSeamContexts; ++c) better |= counts[c][0] + counts[c][1] > 0 && move(c);
        }
    }

    bool join_classes() {
        for (std::uint32_t a = 1; a < kClasses; ++a) {
            if (std::ranges::find(table_.run_class, a) == table_.run_class.end()) continue;
            for (std::uint32_t b = 0; b < kClasses; ++b) {
                SeamTable other = table_;
                std::ranges::replace(other.run_class, static_cast<std::uint8_t>(a), static_cast<std::uint8_t>(b));
                if (b != a && offer(other)) return true;
            }
        }
        return false;
    }

    /// Moves a context to the used class with the fewest bits.
    bool move(std::uint32_t c) {
        std::array<bool, kClasses> used{true};
        for (const std::uint32_t k : table_.run_class) used[k] = true;
        bool better = false;
        for (std::uint32_t k = 0; k < kClasses; ++k) {
            SeamTable other = table_;
            other.run_class[c] = static_cast<std::uint8_t>(k);
            better |= used[k] && k != table_.run_class[c] && offer(other);
        }
        return better;
    }

    bool offer(const SeamTable& table) {
        const std::uint64_t bits = size(table);
        if (bits >= bits_) return false;
        table_ = table;
        bits_ = bits;
        return true;
    }

    std::uint64_t size(const SeamTable& table) const {
        std::uint64_t bits = 0;
        std::size_t end = 0;
        for (const auto& block : blocks_) {
            bits += find_codes(block, table, end, [](std::size_t, std::uint32_t, std::uint32_t, bool) {});
        }
        return bits;
    }

    std::vector<std::span<const SeamAnswer>> blocks_;
    SeamTable table_;
    std::uint64_t bits_ = std::numeric_limits<std::uint64_t>::max();
};

/// Writes the codes of a block.
void write_block(BitWriter& out, std::span<const SeamAnswer> answers, const SeamTable& table) {
    struct Run {
        std::uint32_t length = kNoRun;
        bool last = false;
    };
    std::vector<Run> runs(answers.size());
    std::size_t end = 0;
    find_codes(answers, table, end, [&](std::size_t place, std::uint32_t, std::uint32_t length, bool last) {
        runs[place] = {length, last};
    });
    for (std::size_t i = 0; i < end; ++i) {
        const SeamAnswer& answer = answers[i];
        const std::uint32_t k = answer.context == kSeamContexts ? 0 : table.run_class[answer.context];
        if (k == 0) {
            out.put(answer.value, answer.bits);
        } else if (runs[i].length == kNoRun) {
            continue;
        } else if (k == kRare) {
            out.put(runs[i].last ? 0 : 1, 1);
            if (!runs[i].last) out.put_golomb(runs[i].length, 5);
        } else {
            out.put_rice(runs[i].last ? last_run(runs[i].length, k) : runs[i].length, k - 1);
        }
    }
}

/// Writes a directory: the length of each block, the number of copies it makes, and the sums of both at the beginning
/// of groups. Returns the field widths in the format of the header.
std::uint32_t write_directory(BitWriter& out, std::span<const std::uint32_t> lengths,
                              std::span<const std::uint32_t> copies) {
    if (lengths.empty()) return 0;
    const auto length_bits = static_cast<std::uint32_t>(std::bit_width(std::ranges::max(lengths)));
    const auto copy_bits = static_cast<std::uint32_t>(std::bit_width(std::ranges::max(copies)));
    std::uint32_t length_sum = 0, copy_sum = 0;
    for (std::size_t b = 0; b < lengths.size(); ++b) {
        if (b > 0 && b % LACEDRING_SEAMS_GROUP == 0) {
            out.put(length_sum, 32);
            out.put(copy_sum, 32);
        }
        out.put(lengths[b], length_bits);
        out.put(copies[b], copy_bits);
        length_sum += lengths[b];
        copy_sum += copies[b];
    }
    return length_bits | copy_bits << 8;
}

}  // namespace

SeamTable best_table(const SeamAnswers& vertices, const SeamAnswers& corners) {
    return TableSearch(vertices, corners).best();
}

std::vector<std::uint32_t> write_section(std::uint32_t homes, const SeamAnswers& vertices, const SeamAnswers& corners,
                                         const SeamTable& table) {
    std::vector<std::uint32_t> words{magic::kSeams, 0, homes, 0, 0, 0, 0, 0};
    for (std::uint32_t c = 0; c < kSeamContexts; ++c) {
        words[4 + c / 8] |= (table.likely[c] | std::uint32_t{table.run_class[c]} << 1) << 4 * (c % 8);
    }
    BitWriter out, blocks;
    for (const SeamAnswers* answers : {&vertices, &corners}) {
        const std::size_t before = blocks.bits();
        std::vector<std::uint32_t> lengths;
        for (std::size_t b = 0; b < answers->begin.size(); ++b) {
            const std::size_t begin = blocks.bits();
            write_block(blocks, answers->block(b), table);
            lengths.push_back(static_cast<std::uint32_t>(blocks.bits() - begin));
        }
        if (blocks.bits() - before > UINT32_MAX) return {};
        words[3] |= write_directory(out, lengths, answers->copies) << (answers == &vertices ? 0 : 16);
    }
    const std::size_t bits = blocks.bits();
    const std::vector<std::uint8_t>& bytes = blocks.finish();
    for (std::size_t i = 0; i < bits; i += 8) {
        out.put(bytes[i / 8], static_cast<std::uint32_t>(std::min<std::size_t>(bits - i, 8)));
    }
    if (out.bits() % 32 != 0) out.put(0, 32 - static_cast<std::uint32_t>(out.bits() % 32));
    const std::vector<std::uint8_t>& string = out.finish();
    for (std::size_t i = 0; i < string.size(); i += 4) {
        words.push_back(string[i] | std::uint32_t{string[i + 1]} << 8 | std::uint32_t{string[i + 2]} << 16 |
                        std::uint32_t{string[i + 3]} << 24);
    }
    words[1] = crc32(std::as_bytes(std::span(words).subspan(2)));
    return words;
}

}  // namespace lacedring
