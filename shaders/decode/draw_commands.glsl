// Writes the indirect draw commands of an index buffer; for the shaders that fill the index buffer.

struct DrawIndexedIndirectCommand {
    uint index_count;
    uint instance_count;
    uint first_index;
    int vertex_offset;
    uint first_instance;
};
layout(std430, binding = LR_BINDING_COMMANDS) writeonly buffer Commands { DrawIndexedIndirectCommand commands[]; };

void write_commands(uint draws, uint draw_slots, uint slots) {
    for (uint draw = 0u; draw < draws; ++draw) {
        uint first = min(draw * draw_slots, slots);
        uint count = min(slots - first, draw_slots);
        commands[draw] = DrawIndexedIndirectCommand(3u * count, 1u, 3u * first, 0, 0u);
    }
}
