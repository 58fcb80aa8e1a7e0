// Encodes vertex streams: chooses the best predictors, planes and code widths of each block, and writes its bits.
//
// A block is tried with a few sets of predictors. For each set, the encoder computes residuals, removes a plane from
// each run of vertices, and chooses the widths of the low bits by dynamic programming over the runs, for each size of
// runs. docs/vertex-format.md specifies numbers and codes.

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <optional>

#include "lacedring/lacedring_vertices.h"
#include "lacedring/vertices.hpp"
#include "lrcore/base/parallel.h"
#include "lrcore/base/try.h"
#include "lrcore/codec/bit_writer.h"
#include "lrcore/codec/vertices/quantize.h"
#include "lrcore/codec/vertices/vertex_layout.h"

namespace lacedring {
namespace {

constexpr std::uint32_t kMost = kVertexMostZeros;
constexpr std::uint32_t kGroupBlocks = kVertexGroup;
// Number of possible sizes of a run of vertices with common widths: 4, 8, 16 or 32.
constexpr std::uint32_t kSizes = 4;
constexpr std::uint32_t kPlaneRun = kVertexPlaneRun;
constexpr std::uint32_t kWidths = 32;
constexpr std::uint32_t kSame = 6 + 8 * 2;  // the predictor that repeats the last difference
constexpr std::uint32_t kLast = 2 + 8 * 2;  // the predictor that repeats the last vertex
constexpr std::uint32_t kNever = 1U << 26;  // infinite cost; a sum of several stays below 2^32

std::uint32_t quarter(std::uint32_t x) {
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(x + 2) >> 2);
}
std::uint32_t zigzag(std::uint32_t residual) {
    return (residual << 1) ^ static_cast<std::uint32_t>(static_cast<std::int32_t>(residual) >> 31);
}

// Residuals of one component, for all vertices of the block except the first.
using Residuals = std::array<std::uint32_t, kVertexBlock>;

/// Approximate bits of residuals coded as one run.
std::uint32_t estimate(const std::uint32_t* residuals, std::uint32_t count) {
    std::uint64_t sum = 0;
    for (std::uint32_t i = 0; i < count; ++i) sum += zigzag(residuals[i]);
    if (sum == 0) return 0;
    const auto width = static_cast<std::uint32_t>(std::bit_width(2 * sum / (3 * std::uint64_t{count})));
    const auto low = width > 0 ? width - 1 : 0;
    return static_cast<std::uint32_t>(count * (low + 1) + (sum >> low));
}

struct Plane {
    std::uint32_t axis = 3;  // 3: none
    std::int32_t slope[2] = {0, 0};

    bool operator==(const Plane&) const = default;
};

/// The widths of a component's low bits in a block, and the bits of all its codes.
struct Widths {
    std::uint32_t bits = 0;
    // Code per run: 0 unchanged, 1 all residuals are 0, 2 one more, 3 one less, 4 explicit.
    std::array<std::uint8_t, kVertexBlock / 4> code{};
    std::array<std::uint8_t, kVertexBlock / 4> width{};  // width per run
};

/// Chooses the widths of the runs of one component.
class WidthSearch {
  public:
    /// Computes the costs of each group of four vertices.
    explicit WidthSearch(const std::uint32_t* residuals, std::uint32_t count) : fours_((count + 3) / 4) {
        for (std::uint32_t g = 0; g < fours_; ++g) {
            const std::uint32_t begin = 4 * g, end = std::min(count, begin + 4);
            std::uint32_t largest = 0, all[4];
            for (std::uint32_t i = begin; i < end; ++i) largest |= all[i - begin] = zigzag(residuals[i]);
            zero_[g] = largest == 0;
            const auto width = static_cast<std::uint32_t>(std::bit_width(largest));
            widest_ = std::max(widest_, std::min(width, kWidths - 1));
            for (std::uint32_t k = 0; k < kWidths; ++k) {
                std::uint32_t bits = (k + 1) * (end - begin);
                for (std::uint32_t i = 0; i < end - begin && k < width; ++i) {
                    const std::uint32_t zeros = all[i] >> k;
                    bits += zeros > kMost ? kNever : zeros;
                }
                cost_[g][k] = std::min(bits, kNever);
            }
        }
    }

    /// The best widths for runs of 4 << size vertices, if the block begins with width `before`.
    Widths best(std::uint32_t size, std::uint32_t before) const {
        const std::uint32_t most = std::min(std::max(widest_ + 1, before), kWidths - 1);  // larger widths are useless
        std::array<std::uint32_t, kWidths> bits;
        bits.fill(kNever);
        bits[before] = 0;
        std::array<std::array<std::uint8_t, kWidths>, kVertexBlock / 4> codes;
        std::array<std::uint8_t, kVertexBlock / 4> from;  // [w]: the width before width w
        const std::uint32_t runs = (fours_ + (1U << size) - 1) >> size;
        for (std::uint32_t r = 0; r < runs; ++r) {
            const std::uint32_t begin = r << size, end = std::min(fours_, begin + (1U << size));
            bool zero = true;
            for (std::uint32_t g = begin; g < end; ++g) zero &= zero_[g];
            const auto least = std::min_element(bits.begin(), bits.begin() + most + 1);
            from[r] = static_cast<std::uint8_t>(least - bits.begin());
            const std::uint32_t given = *least + 4 + 5;
            std::array<std::uint32_t, kWidths> now;
            now.fill(kNever);
            for (std::uint32_t k = 0; k <= most; ++k) {
                std::uint32_t own = 0;
                for (std::uint32_t g = begin; g < end; ++g) own += cost_[g][k];
                own = std::min(own, kNever);
                std::uint32_t best = bits[k] + 1 + own;
                std::uint8_t code = 0;
                const auto offer = [&](std::uint32_t cost, std::uint8_t by) {
                    if (cost >= best) return;
                    best = cost;
                    code = by;
                };
                if (zero) offer(bits[k] + 2, 1);
                if (k > 0) offer(bits[k - 1] + 3 + own, 2);
                if (k < most) offer(bits[k + 1] + 4 + own, 3);
                offer(given + own, 4);
                now[k] = std::min(best, kNever);
                codes[r][k] = code;
            }
            bits = now;
        }
        Widths out;
        const auto end = std::min_element(bits.begin(), bits.begin() + most + 1);
        out.bits = *end;
        auto k = static_cast<std::uint32_t>(end - bits.begin());
        for (std::uint32_t r = runs; r-- > 0;) {
            out.code[r] = codes[r][k];
            out.width[r] = static_cast<std::uint8_t>(k);
            if (codes[r][k] == 2)
                --k;
            else if (codes[r][k] == 3)
                ++k;
            else if (codes[r][k] == 4)
                k = from[r];
        }
        return out;
    }

  private:
    std::uint32_t fours_, widest_ = 0;
    std::array<std::array<std::uint32_t, kWidths>, kVertexBlock / 4> cost_;
    std::array<bool, kVertexBlock / 4> zero_{};
};

/// The choices for coding a block.
struct BlockPlan {
    std::uint64_t bits = std::numeric_limits<std::uint64_t>::max();
    std::uint32_t size = 0;  // runs of 4 << size vertices
    std::vector<std::uint32_t> predictors;
    std::array<Plane, kVertexBlock / kPlaneRun> planes;
    std::vector<Residuals> residuals;
    std::vector<Widths> widths;
};

class BlockEncoder {
  public:
    BlockEncoder(const VertexIntegers& of, std::span<const VertexComponent> components)
        : of_(of), n_(of.components), components_(components) {}

    /// The best predictor of each component, chosen independently.
    std::vector<std::uint32_t> best_predictors(std::uint32_t first, std::uint32_t count) const {
        std::vector<std::uint32_t> out(n_);
        for (std::uint32_t c = 0; c < n_; ++c) {
            std::uint32_t least = kNever;
            for (std::uint32_t p = 0; p < 32; ++p) {
                const Residuals residuals = predict(first, count, c, p);
                std::uint32_t bits = 0;
                for (std::uint32_t i = 0; i + 1 < count; i += 16) {
                    bits += std::min(estimate(residuals.data() + i, std::min(16U, count - 1 - i)), kNever / 16);
                }
                if (bits >= least) continue;
                least = bits;
                out[c] = p;
            }
        }
        return out;
    }

    /// The width that fits the average of a component's residuals.
    std::uint32_t usual_width(std::uint32_t first, std::uint32_t count, std::uint32_t c,
                              std::uint32_t predictor) const {
        const Residuals residuals = predict(first, count, c, predictor);
        std::uint64_t sum = 0;
        for (std::uint32_t i = 0; i + 1 < count; ++i) sum += zigzag(residuals[i]);
        const auto width =
            static_cast<std::uint32_t>(std::bit_width(2 * sum / (3 * std::uint64_t{std::max(count, 2U) - 1})));
        return std::min(width > 0 ? width - 1 : 0, kWidths - 1);
    }

    BlockPlan plan(std::uint32_t first, std::uint32_t count) const {
        std::vector<std::vector<std::uint32_t>> tries{best_predictors(first, count)};
        const auto add = [&](std::vector<std::uint32_t> predictors) {
            if (std::find(tries.begin(), tries.end(), predictors) == tries.end())
                tries.push_back(std::move(predictors));
        };
        std::vector<std::uint32_t> usual;
        for (const VertexComponent& component : components_) usual.push_back(component.predictor);
        add(usual);
        add(std::vector<std::uint32_t>(n_, kLast));
        add(std::vector<std::uint32_t>(n_, kSame));
        BlockPlan best;
        for (const auto& predictors : tries) try_predictors(first, count, predictors, best);
        return best;
    }

    void write(BitWriter& out, std::uint32_t first, std::uint32_t count, const BlockPlan& plan) const {
        for (std::uint32_t c = 0; c < n_; ++c) {
            const bool other = plan.predictors[c] != components_[c].predictor;
            out.put(other ? 1 : 0, 1);
            if (other) out.put(plan.predictors[c], 5);
        }
        out.put(plan.size, 2);
        for (std::uint32_t c = 0; c < n_; ++c) out.put(value(first, c) - components_[c].low, components_[c].first_bits);
        Plane last{0, {0, 0}};
        for (std::uint32_t i = 0, r = 0; i + 1 < count; i += 4U << plan.size, ++r) {
            if (n_ == 3 && i % kPlaneRun == 0) write_plane(out, plan.planes[i / kPlaneRun], last);
            for (const Widths& widths : plan.widths) {
                constexpr std::uint8_t kCodes[][2] = {{0, 1}, {1, 2}, {3, 3}, {7, 4}, {15, 4}};  // code, number of bits
                out.put(kCodes[widths.code[r]][0], kCodes[widths.code[r]][1]);
                if (widths.code[r] == 4) out.put(widths.width[r], 5);
            }
            const std::uint32_t end = std::min(count - 1, i + (4U << plan.size));
            for (std::uint32_t j = i; j < end; ++j) {
                for (std::uint32_t c = 0; c < n_; ++c) {
                    if (plan.widths[c].code[r] != 1) out.put(zigzag(plan.residuals[c][j]), plan.widths[c].width[r]);
                }
            }
            for (std::uint32_t j = i; j < end; ++j) {
                for (std::uint32_t c = 0; c < n_; ++c) {
                    if (plan.widths[c].code[r] == 1) continue;
                    const std::uint32_t zeros = zigzag(plan.residuals[c][j]) >> plan.widths[c].width[r];
                    out.put(1U << zeros, zeros + 1);
                }
            }
        }
    }

  private:
    std::uint32_t value(std::uint32_t vertex, std::uint32_t c) const {
        return of_.values[std::size_t{vertex} * n_ + c];
    }

    Residuals predict(std::uint32_t first, std::uint32_t count, std::uint32_t c, std::uint32_t predictor) const {
        const auto alpha = static_cast<std::uint32_t>(static_cast<std::int32_t>(predictor % 8) - 2);
        const auto beta = static_cast<std::uint32_t>(static_cast<std::int32_t>(predictor / 8) - 2);
        Residuals out{};
        const std::uint32_t* at = of_.values.data() + std::size_t{first} * n_ + c;
        std::uint32_t d1 = 0, d2 = 0;
        for (std::uint32_t i = 0; i + 1 < count; ++i, at += n_) {
            const std::uint32_t step = at[n_] - at[0];
            out[i] = step - quarter(alpha * d1 + beta * d2);
            d2 = d1;
            d1 = step;
        }
        return out;
    }

    static Residuals without_plane(const std::vector<Residuals>& of, const Plane& plane, std::uint32_t begin,
                                   std::uint32_t end) {
        const std::uint32_t u = plane.axis == 2 ? 0 : plane.axis + 1, v = plane.axis == 0 ? 2 : plane.axis - 1;
        const auto a = static_cast<std::uint32_t>(plane.slope[0]), b = static_cast<std::uint32_t>(plane.slope[1]);
        Residuals out{};
        for (std::uint32_t i = begin; i < end; ++i) out[i] = of[plane.axis][i] - quarter(a * of[u][i] + b * of[v][i]);
        return out;
    }

    /// Fits a plane through the origin to the residuals: component `axis` as a function of the two others.
    static Plane fit(const std::vector<Residuals>& of, std::uint32_t axis, std::uint32_t begin, std::uint32_t end) {
        const std::uint32_t u = axis == 2 ? 0 : axis + 1, v = axis == 0 ? 2 : axis - 1;
        double uu = 0, uv = 0, vv = 0, um = 0, vm = 0;
        const auto at = [&](std::uint32_t c, std::uint32_t i) {
            return static_cast<double>(static_cast<std::int32_t>(of[c][i]));
        };
        for (std::uint32_t i = begin; i < end; ++i) {
            uu += at(u, i) * at(u, i);
            uv += at(u, i) * at(v, i);
            vv += at(v, i) * at(v, i);
            um += at(u, i) * at(axis, i);
            vm += at(v, i) * at(axis, i);
        }
        const double determinant = uu * vv - uv * uv;
        Plane out;
        out.axis = axis;
        const auto slope = [](double x) {  // in quarters
            return x > -1 && x < 0.75 ? static_cast<std::int32_t>(x * 4 + 4.5) - 4 : x > 0 ? 3 : -4;
        };
        if (determinant > 1e-6 * uu * vv) {
            out.slope[0] = slope((um * vv - vm * uv) / determinant);
            out.slope[1] = slope((vm * uu - um * uv) / determinant);
        } else if (uu > 0 || vv > 0) {  // all residuals are on a line
            (uu >= vv ? out.slope[0] : out.slope[1]) = slope(uu >= vv ? um / uu : vm / vv);
        }
        return out;
    }

    /// Subtracts planes from the residuals of runs where this saves bits. Returns the bits of the planes.
    static std::uint32_t take_planes(std::vector<Residuals>& residuals, std::uint32_t count, std::uint32_t run,
                                     std::array<Plane, kVertexBlock / kPlaneRun>& planes) {
        Plane last{0, {0, 0}};
        std::uint32_t total = 0;
        for (std::uint32_t begin = 0; begin + 1 < count; begin += run) {
            const std::uint32_t end = std::min(count - 1, begin + run);
            std::uint32_t alone[3];
            for (std::uint32_t c = 0; c < 3; ++c) {
                alone[c] = std::min(estimate(residuals[c].data() + begin, end - begin), kNever / 4);
            }
            std::uint32_t gained = 0, bits = 1;
            Plane best;
            Residuals best_residuals;
            const auto offer = [&](const Plane& plane, std::uint32_t cost) {
                const Residuals without = without_plane(residuals, plane, begin, end);
                const std::uint32_t now = estimate(without.data() + begin, end - begin) + cost - 1;
                if (now >= alone[plane.axis] || alone[plane.axis] - now <= gained) return;
                gained = alone[plane.axis] - now;
                bits = cost;
                best = plane;
                best_residuals = without;
            };
            offer(last, 2);
            for (std::uint32_t axis = 0; axis < 3; ++axis) offer(fit(residuals, axis, begin, end), 10);
            total += bits;
            planes[begin / kPlaneRun] = best;
            if (best.axis == 3) continue;
            std::copy(best_residuals.begin() + begin, best_residuals.begin() + end,
                      residuals[best.axis].begin() + begin);
            last = best;
        }
        return total;
    }

    void try_predictors(std::uint32_t first, std::uint32_t count, const std::vector<std::uint32_t>& predictors,
                        BlockPlan& best) const {
        std::vector<Residuals> plain;
        std::uint64_t fixed = 2;
        for (std::uint32_t c = 0; c < n_; ++c) {
            plain.push_back(predict(first, count, c, predictors[c]));
            fixed += components_[c].first_bits + (predictors[c] == components_[c].predictor ? 1 : 6);
        }
        for (std::uint32_t longest = 0; longest < (n_ == 3 ? 2 : 1); ++longest) {  // planes of 16 or 32 vertices
            std::array<Plane, kVertexBlock / kPlaneRun> planes;
            std::vector<Residuals> residuals = plain;
            const std::uint32_t plane_bits = n_ == 3 ? take_planes(residuals, count, kPlaneRun << longest, planes) : 0;
            std::vector<WidthSearch> searches;
            searches.reserve(n_);
            for (const Residuals& of : residuals) searches.emplace_back(of.data(), count - 1);
            for (std::uint32_t size = longest * (kSizes - 1); size < (n_ == 3 && longest == 0 ? kSizes - 1 : kSizes);
                 ++size) {
                std::uint64_t bits = fixed + plane_bits;
                std::vector<Widths> widths;
                for (std::uint32_t c = 0; c < n_ && bits < best.bits; ++c) {
                    widths.push_back(searches[c].best(size, components_[c].width));
                    bits += widths.back().bits;
                }
                if (bits >= best.bits) continue;
                best = {bits, size, predictors, planes, residuals, std::move(widths)};
            }
        }
    }

    static void write_plane(BitWriter& out, const Plane& plane, Plane& last) {
        if (plane.axis == 3) {
            out.put(0, 1);
        } else if (plane == last) {
            out.put(1, 2);
        } else {
            out.put(3, 2);
            out.put(plane.axis, 2);
            for (const std::int32_t slope : plane.slope) out.put(static_cast<std::uint32_t>(slope + 4), 3);
            last = plane;
        }
    }

    const VertexIntegers& of_;
    std::uint32_t n_;
    std::span<const VertexComponent> components_;
};

std::vector<VertexComponent> find_components(const VertexIntegers& of, std::uint32_t vertices) {
    const std::uint32_t n = of.components;
    std::vector<VertexComponent> out(n);
    for (VertexComponent& component : out) component.predictor = kLast;
    find_vertex_ranges(of.values, of.mapping, out);
    // The usual predictor and first width: the most frequent in about a hundred sampled blocks.
    const std::uint32_t blocks = (vertices + kVertexBlock - 1) / kVertexBlock, step = std::max(1U, blocks / 128);
    const BlockEncoder encoder(of, out);
    std::vector<std::array<std::uint32_t, 32>> predictors(n), widths(n);
    const auto most = [](const std::array<std::uint32_t, 32>& counts) {
        return static_cast<std::uint32_t>(std::max_element(counts.begin(), counts.end()) - counts.begin());
    };
    for (auto& counts : predictors) counts.fill(0);
    for (auto& counts : widths) counts.fill(0);
    for (std::uint32_t block = 0; block < blocks; block += step) {
        const std::uint32_t first = block * kVertexBlock, count = std::min(vertices - first, kVertexBlock);
        const std::vector<std::uint32_t> best = encoder.best_predictors(first, count);
        for (std::uint32_t c = 0; c < n; ++c) {
            ++predictors[c][best[c]];
            ++widths[c][encoder.usual_width(first, count, c, best[c])];
        }
    }
    for (std::uint32_t c = 0; c < n && vertices > 0; ++c) {
        out[c].predictor = most(predictors[c]);
        out[c].width = most(widths[c]);
    }
    return out;
}

/// The coded blocks of one group of the table.
struct Group {
    std::vector<std::uint32_t> words;
    std::array<std::uint32_t, kGroupBlocks> begins{};  // first bit of each block
};

Result<EncodedVertices> encode_integers(const VertexIntegers& integers, const VertexValues& values, unsigned threads) {
    const auto vertices = static_cast<std::uint32_t>(values.data.size() / values.stride());
    const std::vector<VertexComponent> components = find_components(integers, vertices);
    const BlockEncoder encoder(integers, components);
    const std::uint32_t blocks = (vertices + kVertexBlock - 1) / kVertexBlock;
    std::vector<Group> groups((blocks + kGroupBlocks - 1) / kGroupBlocks);
    detail::in_parallel(threads, static_cast<std::uint32_t>(groups.size()), [&](std::uint32_t g) {
        Group& group = groups[g];
        BitWriter bits;
        for (std::uint32_t block = g * kGroupBlocks; block < std::min(blocks, (g + 1) * kGroupBlocks); ++block) {
            group.begins[block - g * kGroupBlocks] = static_cast<std::uint32_t>(bits.bits());
            const std::uint32_t first = block * kVertexBlock, count = std::min(vertices - first, kVertexBlock);
            encoder.write(bits, first, count, encoder.plan(first, count));
        }
        while (bits.bits() % 32 != 0) bits.put(0, 1);
        const std::vector<std::uint8_t>& bytes = bits.finish();
        group.words.resize(bytes.size() / 4);
        std::memcpy(group.words.data(), bytes.data(), bytes.size());
    });

    std::uint32_t farthest = 0;
    for (const Group& group : groups)
        farthest = std::max(farthest, *std::max_element(group.begins.begin(), group.begins.end()));
    const auto field = static_cast<std::uint32_t>(std::bit_width(farthest));
    const auto largest_error = [&] {  // rounded up to a float
        auto error = static_cast<float>(integers.largest_error);
        if (static_cast<double>(error) < integers.largest_error)
            error = std::bit_cast<float>(std::bit_cast<std::uint32_t>(error) + 1);
        return error;
    }();
    std::vector<std::uint32_t> data;
    std::vector<std::uint64_t> begins;
    for (std::size_t g = 0; g < groups.size(); ++g) {
        if (data.size() > UINT32_MAX) return Error{ErrorCode::too_large, "more than 16 GiB of vertices"};
        const std::size_t here = std::min<std::size_t>(kGroupBlocks, blocks - g * kGroupBlocks);
        for (std::size_t k = 0; k < here; ++k) begins.push_back(std::uint64_t{32} * data.size() + groups[g].begins[k]);
        data.insert(data.end(), groups[g].words.begin(), groups[g].words.end());
        groups[g].words = {};
    }
    const auto type = integers.mapping == VertexMapping::lattice ? ComponentType::f32 : values.type;
    VertexStreamParts parts;
    parts.vertices = vertices;
    parts.layout = integers.components | static_cast<std::uint32_t>(integers.mapping) << 5 |
                   static_cast<std::uint32_t>(type) << 8 | static_cast<std::uint32_t>(values.normalized) << 12 |
                   integers.bits << 13 | field << 18;
    parts.parameter =
        integers.mapping == VertexMapping::decimals ? integers.digits : std::bit_cast<std::uint32_t>(integers.step);
    parts.largest_error = std::bit_cast<std::uint32_t>(largest_error);
    parts.components = components;
    parts.exceptions = integers.exceptions;
    parts.begins = begins;
    parts.data = data;
    EncodedVertices out;
    out.largest_error = integers.largest_error;
    out.words = make_vertex_stream(parts);
    return out;
}

}  // namespace

Result<EncodedVertices> encode_vertices(const VertexValues& values, const VertexOptions& options) {
    LR_ASSIGN(VertexIntegers integers, to_integers(values, options));
    Result<EncodedVertices> out = encode_integers(integers, values, options.threads);
    // Lossless decimals replace the requested mapping if they are smaller, unless a given step shares the lattice with
    // other meshes.
    if (!out || options.step != 0) return out;
    const std::optional<VertexIntegers> decimals = to_decimals(values);
    if (!decimals) return out;
    Result<EncodedVertices> other = encode_integers(*decimals, values, options.threads);
    return other && other->words.size() < out->words.size() ? other : out;
}

}  // namespace lacedring
