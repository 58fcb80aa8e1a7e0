#include "lrlab/generate/generate.h"

#include <new>
#include <stdexcept>
#include <string>

#include "lrlab/generate/detail.h"

namespace lacedring {
namespace {

constexpr GeneratorInfo infos[] = {
    {"sphere", "closed surface of genus 0, nearly all valences 6"},
    {"torus", "closed surface of genus 1, all valences 6"},
    {"genus", "closed surface of genus 2 + seed % 30: a plate with holes"},
    {"terrain", "height field with an outer border and holes"},
    {"blob", "bumpy closed surface of genus 0 with irregular valences, in scan order"},
    {"parts", "many small unconnected pieces, open and closed"},
    {"moebius", "strip with a half twist, not orientable"},
    {"soup", "non-manifold, duplicate, degenerate and wrongly oriented triangles, unused vertices"},
};

using Make = Result<Mesh> (*)(std::uint64_t triangles, std::uint64_t seed);
constexpr Make makers[] = {detail::make_sphere, detail::make_torus, detail::make_genus,   detail::make_terrain,
                           detail::make_blob,   detail::make_parts, detail::make_moebius, detail::make_soup};
static_assert(std::size(infos) == std::size(makers));

}  // namespace

std::span<const GeneratorInfo> generators() {
    return infos;
}

Result<Mesh> generate(std::string_view kind, std::uint64_t triangles, std::uint64_t seed) {
    for (std::size_t i = 0; i < std::size(infos); ++i) {
        if (infos[i].name != kind) continue;
        // Each kind has about T/2 vertices or more. The check also prevents overflow in the generators' arithmetic.
        if (triangles > 2 * detail::kMostVertices) return detail::too_many_generated();
        try {
            return makers[i](triangles, seed);
        } catch (const std::bad_alloc&) {
            return Error{ErrorCode::too_large, "not enough memory for " + std::to_string(triangles) + " triangles"};
        } catch (const std::length_error&) {
            return Error{ErrorCode::too_large, "not enough memory for " + std::to_string(triangles) + " triangles"};
        }
    }
    std::string known;
    for (const GeneratorInfo& info : infos) known.append(known.empty() ? "" : ", ").append(info.name);
    return Error{ErrorCode::invalid_argument, "unknown kind '" + std::string(kind) + "' (known: " + known + ")"};
}

}  // namespace lacedring
