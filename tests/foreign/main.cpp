// A renderer that uses only the installed package: lacedring::encode_lean and lacedring::encode_packed on the host,
// lacedring.glsl on the device. It draws a mesh from its index list and from its streams in every way
// (docs/engine-guide.md) and compares the pictures.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <exception>
#include <lacedring/mesh_files.hpp>
#include <lacedring/streams.hpp>
#include <string>

#include "lacedring/lacedring.hpp"
#include "spirv/color_frag.h"
#include "spirv/expand_lean_comp.h"
#include "spirv/expand_packed_comp.h"
#include "spirv/indexed_vert.h"
#include "spirv/points_lean_geom.h"
#include "spirv/points_vert.h"
#include "spirv/pull_lean_vert.h"
#include "spirv/pull_packed_vert.h"
#include "spirv/triangles_lean_mesh.h"
#include "spirv/triangles_packed_mesh.h"
#include "vulkan.h"

namespace {

// docs/lean-format.md, docs/packed-format.md. The last word of a header is the checksum.
constexpr std::size_t kLeanHeaderWords = 8, kPackedHeaderWords = 4;
constexpr std::uint32_t kTipMask = 0x1fffffff;

/// A stream of either format as an engine keeps it: words to upload, and the order of its vertices.
struct Stream {
    bool lean;
    std::vector<std::uint32_t> words, vertex_order;
    std::uint32_t triangles;  ///< to draw; of a lean stream its slots, some degenerate
};

Stream lean_stream(const lacedring::CornerTable& table, const lacedring::Rings& rings) {
    auto lean = lacedring::encode_lean(table, rings);
    if (!lean) throw std::runtime_error(lean.error().message);
    const std::uint32_t slots = lacedring::view_lean(lean->words)->slots();
    return {true, std::move(lean->words), std::move(lean->vertex_order), slots};
}

Stream packed_stream(const lacedring::CornerTable& table, const lacedring::Rings& rings) {
    auto packed = lacedring::encode_packed(table, rings, lacedring::PackedProfile::cache);
    if (!packed) throw std::runtime_error(packed.error().message);
    const std::uint32_t triangles = lacedring::view_packed(packed->words)->triangles;
    return {false, std::move(packed->words), std::move(packed->vertex_order), triangles};
}

std::size_t triangles_changed(const Stream& stream, std::span<const std::uint32_t> words) {
    std::vector<std::uint32_t> before(std::size_t{3} * stream.triangles), after(before.size());
    lacedring::decode_packed(*lacedring::view_packed(stream.words), before);
    lacedring::decode_packed(*lacedring::view_packed(words), after);
    std::size_t count = 0;
    for (std::size_t i = 0; i < before.size(); i += 3) {
        count += std::equal(&before[i], &before[i] + 3, &after[i]) ? 0 : 1;
    }
    return count;
}

/// Changes one tip or turn, which makes a valid stream of another mesh; more than one if the mesh is large, because its
/// triangles are small.
void break_stream(Stream& stream, std::uint32_t vertices) {
    for (std::uint32_t at = stream.triangles / 3; at < stream.triangles; ++at) {
        std::vector<std::uint32_t> words = stream.words;
        if (stream.lean) {
            std::uint32_t& word = words[kLeanHeaderWords + at];
            if ((word & ~kTipMask) != 0) continue;
            word = (word + vertices / 2) % vertices;
            words[kLeanHeaderWords - 1] = lacedring::lean_checksum(words);
        } else {
            words[kPackedHeaderWords + at / 32] ^= 1U << at % 32;
            words[kPackedHeaderWords - 1] = lacedring::packed_checksum(words);
        }
        if (stream.lean ? lacedring::validate_lean(words).has_value()
                        : lacedring::validate_packed(words).has_value() && triangles_changed(stream, words) >= 10) {
            stream.words = std::move(words);
            return;
        }
    }
    throw std::runtime_error("no place to break the stream");
}

/// A camera at a corner of the bounding box that sees the whole mesh.
Push look_at(const std::vector<float>& positions) {
    float low[3], high[3];
    for (int i = 0; i < 3; ++i) low[i] = high[i] = positions[static_cast<std::size_t>(i)];
    for (std::size_t k = 0; k < positions.size(); ++k) {
        low[k % 3] = std::min(low[k % 3], positions[k]);
        high[k % 3] = std::max(high[k % 3], positions[k]);
    }
    constexpr float axes[3][3] = {{0.8F, 0.0F, -0.6F}, {0.36F, -0.8F, 0.48F}, {-0.48F, -0.6F, -0.64F}};
    const float radius = std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]) / 2;
    Push push{};
    for (std::size_t row = 0; row < 3; ++row) {
        const float scale = (row == 2 ? 0.5F : 1.0F) / radius;
        push.camera[12 + row] = row == 2 ? 0.5F : 0.0F;
        for (std::size_t i = 0; i < 3; ++i) {
            push.camera[4 * i + row] = scale * axes[row][i];
            push.camera[12 + row] -= scale * axes[row][i] * (low[i] + high[i]) / 2;
        }
    }
    push.camera[15] = 1;
    return push;
}

/// The mesh's index list, each triangle rotated to begin with the vertex that is first in the stream.
std::vector<std::uint32_t> plain_indices(const lacedring::Mesh& mesh, const std::vector<std::uint32_t>& vertex_order) {
    std::vector<std::uint32_t> rank(mesh.vertex_count), indices = mesh.indices;
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) rank[vertex_order[v]] = v;
    for (auto t = indices.begin(); t != indices.end(); t += 3) {
        const auto less = [&](std::uint32_t a, std::uint32_t b) { return rank[a] < rank[b]; };
        std::rotate(t, std::min_element(t, t + 3, less), t + 3);
    }
    return indices;
}

/// Prints a line and returns whether the pictures are equal. `nearly`: one pixel in 10,000 may differ by 1/255.
bool compare(const std::string& way, const Picture& plain, const Picture& picture, bool nearly) {
    std::size_t covered = 0, different = 0;
    int most = 0;
    for (std::size_t i = 0; i < plain.size(); ++i) {
        covered += picture[i] >> 24 != 0 ? 1 : 0;
        different += picture[i] != plain[i] ? 1 : 0;
        for (unsigned shift = 0; shift < 32; shift += 8) {
            const auto channel = [&](std::uint32_t pixel) { return static_cast<int>(pixel >> shift & 0xffU); };
            most = std::max(most, std::abs(channel(plain[i]) - channel(picture[i])));
        }
    }
    const bool blank = covered < plain.size() / 20;
    const bool same = different == 0 || (nearly && different <= plain.size() / 10000 && most <= 1);
    std::printf("%-22s %7zu pixels covered %7zu different, by %d  %s\n", way.c_str(), covered, different, most,
                blank  ? "BLANK"
                : same ? "same"
                       : "DIFFERENT");
    return same && !blank;
}

bool draw_all(Gpu& gpu, const lacedring::Mesh& mesh, bool broken) {
    const std::vector<float> positions = lacedring::positions_f32(mesh);
    const Push push = look_at(positions);
    const auto table = lacedring::build_corner_table(mesh.indices, mesh.vertex_count);
    if (!table) throw std::runtime_error(table.error().message);
    const lacedring::Rings rings = lacedring::expand_rings(*table);

    constexpr auto storage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    constexpr auto vertex = storage | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT;
    constexpr auto index = storage | VK_BUFFER_USAGE_INDEX_BUFFER_BIT;
    const Stage vertices{VK_SHADER_STAGE_VERTEX_BIT, indexed_vert};
    const Stage color{VK_SHADER_STAGE_FRAGMENT_BIT, color_frag};
    const VkPipeline indexed = gpu.graphics(std::array{vertices, color}, Input::indexed);

    // Plain vkCmdDrawIndexed.
    const auto draw_indexed = [&](const Buffer& vertex_buffer, const Buffer& indices, std::uint32_t triangles) {
        return [=](VkCommandBuffer commands) {
            constexpr VkDeviceSize zero = 0;
            vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, indexed);
            vkCmdBindVertexBuffers(commands, 0, 1, &vertex_buffer.handle, &zero);
            vkCmdBindIndexBuffer(commands, indices.handle, 0, VK_INDEX_TYPE_UINT32);
            vkCmdDrawIndexed(commands, 3 * triangles, 1, 0, 0, 0);
        };
    };
    // Without index and vertex buffers: the shaders read the stream and the vertices.
    const auto draw_pulled = [&](VkPipeline pipeline, std::uint32_t count) {
        return [=](VkCommandBuffer commands) {
            vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
            vkCmdDraw(commands, count, 1, 0, 0);
        };
    };

    const Buffer plain_vertices = gpu.buffer(positions.size() * sizeof(float), vertex, positions.data());
    bool good = true;
    for (Stream stream : {lean_stream(*table, rings), packed_stream(*table, rings)}) {
        const bool lean = stream.lean;
        const std::string name = lean ? "lean" : "packed";
        const std::vector<std::uint32_t> list = plain_indices(mesh, stream.vertex_order);
        const Buffer plain_list = gpu.buffer(list.size() * 4, index, list.data());
        const Picture plain =
            gpu.draw(push, VK_NULL_HANDLE, nullptr,
                     draw_indexed(plain_vertices, plain_list, static_cast<std::uint32_t>(list.size() / 3)));
        good &= compare("plain, against " + name, plain, plain, false);
        if (broken) break_stream(stream, mesh.vertex_count);

        // Only the words and the vertices in the stream's order are uploaded.
        std::vector<float> ordered(positions.size());
        for (std::size_t v = 0; v < stream.vertex_order.size(); ++v) {
            std::copy_n(&positions[3 * std::size_t{stream.vertex_order[v]}], 3, &ordered[3 * v]);
        }
        const Buffer words = gpu.buffer(stream.words.size() * 4, storage, stream.words.data());
        const Buffer stream_vertices = gpu.buffer(ordered.size() * sizeof(float), vertex, ordered.data());
        const Buffer indices = gpu.buffer(std::size_t{12} * stream.triangles, index);
        const VkDescriptorSet set = gpu.descriptors(words, stream_vertices, indices);

        const auto draw = [&](const char* way, const Record& prepare, const Record& record, bool nearly = false) {
            good &= compare(name + " " + way, plain, gpu.draw(push, set, prepare, record), nearly);
        };
        const Stage pull{VK_SHADER_STAGE_VERTEX_BIT, lean ? Spirv(pull_lean_vert) : Spirv(pull_packed_vert)};
        const VkPipeline pulling = gpu.graphics(std::array{pull, color}, Input::triangles);
        draw("vertex", nullptr, draw_pulled(pulling, 3 * stream.triangles));

        const auto expand_with = [&](VkPipeline pipeline, std::uint32_t invocations) {
            return [=](VkCommandBuffer commands) {
                vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
                vkCmdDispatch(commands, (invocations + 63) / 64, 1, 1);
                const VkMemoryBarrier2 barrier{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                               .srcStageMask = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                               .srcAccessMask = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                                               .dstStageMask = VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT,
                                               .dstAccessMask = VK_ACCESS_2_INDEX_READ_BIT};
                const VkDependencyInfo dependency{
                    .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .memoryBarrierCount = 1, .pMemoryBarriers = &barrier};
                vkCmdPipelineBarrier2(commands, &dependency);
            };
        };
        const Record drawing = draw_indexed(stream_vertices, indices, stream.triangles);
        const VkPipeline expand = gpu.compute(lean ? Spirv(expand_lean_comp) : Spirv(expand_packed_comp));
        draw("compute", expand_with(expand, stream.triangles), drawing);
        if (lean) {
            const Stage points{VK_SHADER_STAGE_VERTEX_BIT, points_vert};
            const Stage make{VK_SHADER_STAGE_GEOMETRY_BIT, points_lean_geom};
            const VkPipeline geometry = gpu.graphics(std::array{points, make, color}, Input::points);
            draw("geometry", nullptr, draw_pulled(geometry, stream.triangles), true);
        }
        if (gpu.has_mesh_shaders()) {
            const Stage make{VK_SHADER_STAGE_MESH_BIT_EXT,
                             lean ? Spirv(triangles_lean_mesh) : Spirv(triangles_packed_mesh)};
            const VkPipeline pipeline = gpu.graphics(std::array{make, color}, Input::mesh);
            const auto tasks = [&](VkCommandBuffer commands) {
                vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
                gpu.draw_mesh_tasks(commands, (stream.triangles + 63) / 64, 1, 1);
            };
            draw("mesh", nullptr, tasks, true);
        }
    }
    return good;
}

}  // namespace

int main(int argc, char** argv) {
    const bool broken = argc == 3 && std::strcmp(argv[1], "--break") == 0;
    if (argc != 2 && !broken) return std::printf("foreign [--break] MESH\n"), 2;
    const lacedring::Result<lacedring::Mesh> mesh = lacedring::read_mesh(argv[argc - 1]);
    if (!mesh) return std::printf("%s\n", mesh.error().message.c_str()), 2;
    std::uint32_t messages = 0;
    bool good = false;
    try {
        Gpu gpu(messages);
        good = draw_all(gpu, *mesh, broken);
    } catch (const std::exception& e) {
        std::printf("%s\n", e.what());
    }
    if (messages != 0) std::printf("%u validation messages\n", messages);
    return good && messages == 0 ? 0 : 1;
}
