#pragma once
// Reads back what the pull, geometry and mesh shaders decode, for comparison with the CPU.

#include <array>
#include <vector>

#include "renderer/mesh/gpu_mesh.h"
#include "renderer/vk/commands.h"
#include "renderer/vk/pipeline.h"
#include "renderer/vk/transfer.h"

namespace lacedring::gpu {

struct WordsRead {
    std::uint64_t all = 0;
    std::uint32_t most = 0;  ///< largest count of one slot, or of a group of four (Path::geometry)
};

class SlotReader {
  public:
    static Result<SlotReader> create(Context& context);

    /// Returns 3 indices per slot of a mesh that has a stream, decoded by shaders/draw/slot_source.glsl. Creates the
    /// pipeline at its first use. Device memory: up to 16 MiB while it runs.
    Result<std::vector<std::uint32_t>> read(Commands& commands, Transfer& transfer, const GpuMesh& mesh);

    /// Returns 3 words per vertex: the bits of the positions that the shaders decode from the vertex stream.
    Result<std::vector<std::uint32_t>> positions(Commands& commands, Transfer& transfer, const GpuMesh& mesh);

    /// Counts the stream words loaded when every slot is decoded once: singly, or by fours with Path::geometry.
    Result<WordsRead> words_read(Commands& commands, Transfer& transfer, const GpuMesh& mesh);

  private:
    enum class Task { indices, words, words_by_fours, positions };
    /// Dispatches a task over all slots or vertices, in parts. After each part, `done(first, count, buffer)` reads its
    /// results.
    template <class Done>
    Result<void> run(Commands& commands, const GpuMesh& mesh, Task task, const Done& done);

    Context* context_ = nullptr;
    Layout layout_;
    /// Returns the three words that the task writes for each slot or vertex.
    Result<std::vector<std::uint32_t>> read_threes(Commands& commands, Transfer& transfer, const GpuMesh& mesh,
                                                   Task task);

    std::array<PipelineHandle, 8> pipelines_;  // [2 * task + (packed ? 1 : 0)]
};

}  // namespace lacedring::gpu
