#pragma once
// What the shaders that decode by themselves decode, read back: the proof that it is what the CPU does.

#include <array>
#include <vector>

#include "renderer/mesh/gpu_mesh.h"
#include "renderer/vk/commands.h"
#include "renderer/vk/pipeline.h"
#include "renderer/vk/transfer.h"

namespace lacedring::gpu {

struct WordsRead {
    std::uint64_t all = 0;
    std::uint32_t most = 0;  ///< by one slot, or by four
};

class SlotReader {
  public:
    static Result<SlotReader> create(Context& context);

    /// 3 indices a slot of a mesh that has a stream, by shaders/draw/slot_source.glsl. The pipelines are made when they
    /// are first needed. Device memory: up to 16 MiB while it runs.
    Result<std::vector<std::uint32_t>> read(Commands& commands, Transfer& transfer, const GpuMesh& mesh);

    /// 3 words a vertex: the bits of the positions that shaders decode by themselves from the vertex stream.
    Result<std::vector<std::uint32_t>> positions(Commands& commands, Transfer& transfer, const GpuMesh& mesh);

    /// Words of the stream that it takes to decode every slot once, as the mesh's path does: each by itself, or four at
    /// a time.
    Result<WordsRead> words_read(Commands& commands, Transfer& transfer, const GpuMesh& mesh);

  private:
    enum class Task { indices, words, words_by_fours, positions };
    /// Dispatches a task over all slots, or vertices, in parts; `done(first, count, buffer)` reads what each part has
    /// written.
    template <class Done>
    Result<void> run(Commands& commands, const GpuMesh& mesh, Task task, const Done& done);

    Context* context_ = nullptr;
    Layout layout_;
    /// Three words of each slot or vertex.
    Result<std::vector<std::uint32_t>> read_threes(Commands& commands, Transfer& transfer, const GpuMesh& mesh,
                                                   Task task);

    std::array<PipelineHandle, 8> pipelines_;  // lean, packed; of each task
};

}  // namespace lacedring::gpu
