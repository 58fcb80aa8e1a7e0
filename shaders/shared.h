// Structs and constants that C++ and GLSL both read. Members are laid out alike under std140 and in C++.
#ifndef LACEDRING_SHADERS_SHARED_H
#define LACEDRING_SHADERS_SHARED_H

#ifdef __cplusplus
#include <array>
#include <cstdint>
namespace lacedring::gpu {
using uint = std::uint32_t;
using uvec2 = std::array<std::uint32_t, 2>;
using uvec4 = std::array<std::uint32_t, 4>;
using vec4 = std::array<float, 4>;
using mat4 = std::array<float, 16>;  // column-major
#endif

// Four triangles an invocation: 12 indices, three 16-byte stores (wide stores are what makes the decoder fast).
#define LR_TRIANGLES_PER_INVOCATION 4u
#define LR_COMPUTE_GROUP 128u  // as many as every device has

#define LR_CONSTANT_BLOCKS 1      // packed_decode.comp: blocks of a workgroup
#define LR_CONSTANT_COMPONENTS 0  // vertex_decode.comp: integers of a vertex
#define LR_CONSTANT_INTEGERS 1    // vertex_decode.comp: writes them, not the values they stand for
#define LR_CONSTANT_MAPPING 2     // vertex_decode.comp: what they stand for

#define LR_CONSTANT_SEAM_PASS 0  // seam_decode.comp: LR_SEAM_PASS_*

// lean_decode.comp, packed_decode.comp: one dispatch expands `slots` slots from `first_slot`, through descriptors that
// cover only what these need.
struct DecodeConstants {
    uint first_slot;  // a multiple of LR_TRIANGLES_PER_INVOCATION; packed: of LR_PACKED_BLOCK
    uint slots;       // slots of this dispatch
    uint draws;       // draw commands to write: 0 in every dispatch but one
    uint draw_slots;  // slots of each draw command but the last
    uint first_word;  // lean: word of the stream (header included) at which its descriptor begins
    uint words;       // packed: of the stream
    uvec2 stream;     // packed: its address
};

// vertex_decode.comp: one dispatch decodes `blocks` blocks from `first_block`. Its descriptor begins at their first
// vertex.
struct VertexConstants {
    uint first_block;
    uint blocks;
    uint stride;  // words from one vertex to the next
    uint unused;
    uvec2 stream;  // its address
};
#define LR_VERTEX_GROUP_SIZE 32u  // of this and of seam_decode.comp: invocations, a block each

// seam_decode.comp: one dispatch decodes `blocks` blocks from `first_block`, or moves the positions of that many
// copies. Its descriptors begin at the first vertex, the first corner, or the first copy, of these.
struct SeamConstants {
    uint first_block;
    uint blocks;
    uint vertices;  // of the surface
    uint slots;     // of its stream
    uint copies;
    uint words;     // of the section
    uvec2 section;  // addresses
    uvec2 homes;
    uvec2 copy_vertices;
    uvec2 positions;
};
#define LR_SEAM_PASS_VERTICES 0u   // decodes vertex blocks
#define LR_SEAM_PASS_TRIANGLES 1u  // decodes triangle blocks
#define LR_SEAM_PASS_POSITIONS 2u  // gives each copy the position of its vertex

// rotate.comp: the window of the index buffer is the descriptor's.
struct RotateConstants {
    uint triangles;      // in this dispatch
    uint ordered;        // 0: vertices have their original numbers; 1: vertex_order has them
    uvec2 vertex_order;  // its address
};

// One picture.
struct FrameConstants {
    mat4 view_from_world;
    mat4 clip_from_view;
    vec4 line_colour;  // with its opacity
};
// Lines over the surface are drawn this share of their distance nearer to the eye.
#define LR_LINE_LIFT 0.0012

// One draw command. All per-triangle buffers are bound at the draw's first slot.
struct DrawConstants {
    uint first_slot;  // of the draw; plain: the original triangle of the draw's first one
    uint ordered;     // 1: slot_triangle has the original triangle of each slot
    uint slots;       // of the draw
    uint unused;
    // Where shaders decode by themselves, the addresses of:
    uvec2 stream;
    uvec2 vertices;
    uvec2 vertex_order;
    uvec2 vertex_stream;
    uvec2 copies;
    uvec2 copy_vertices;
    // Of LR_VIEW_MATERIAL: LR_SHADING_WORDS of each vertex, and a MaterialHead.
    uvec2 shading;
    uvec2 materials;
    uvec4 stream_layout;  // lean: LrLeanLayout; packed: LrPackedLayout
    // Positions are (x - unit.xyz) * unit.w in the unit sphere.
    vec4 unit;
};

// Specialization constants of the shaders that decode by themselves (0 and 1 are surface.frag's).
#define LR_CONSTANT_PACKED 2         // of a packed stream
#define LR_CONSTANT_ROTATE 3         // triangles begin with their smallest original vertex
#define LR_CONSTANT_VERTEX_STREAM 4  // positions are decoded from a vertex stream

#define LR_CONSTANT_SEAMS 5  // triangles are read from `copies`

#define LR_CONSTANT_FOURS 6  // slot_words.comp: four slots at a time

// Floats of a vertex: position (none where a shader decodes it from a vertex stream), normal, place along the rings.
#define LR_POSITION_FLOATS 3u
#define LR_VERTEX_FLOATS 7u
// Slots of a point that surface.geom gets.
#define LR_GEOMETRY_SLOTS 4u
// Triangles of a workgroup of surface.mesh; three times as many vertices, and both are within what Vulkan promises.
#define LR_MESH_TRIANGLES 64u

#define LR_VIEW_SMOOTH 0u
#define LR_VIEW_FLAT 1u
#define LR_VIEW_CLASS 2u
#define LR_VIEW_RING 3u
#define LR_VIEW_WIRE 4u
#define LR_VIEW_OFFSETS 5u
#define LR_VIEW_SILHOUETTE 6u
#define LR_VIEW_SEAMS 7u
#define LR_VIEW_MATERIAL 8u

// What a vertex is drawn with, beside LR_VERTEX_FLOATS: two sets of texture coordinates, as floats, and a color of four
// numbers of 16 bits.
#define LR_SHADING_WORDS 6u

// Materials on the device: this, then a MaterialConstants for each.
struct MaterialHead {
    uvec2 of_triangle;  // address: the number of the material of each of the mesh's triangles
    uvec2 texels;       // address: of all images and their mip maps, row by row, a byte a channel
};
// A texture of a material.
struct TextureConstants {
    uint first;     // texel of the largest mip map, the others follow
    uint size;      // width and height, 16 bits each; 0: there is no texture
    uint levels;    // mip maps
    uint sampling;  // LR_TEXTURE_*
    // To the image's coordinates from those of the set: two rows.
    vec4 u, v;
};
#define LR_TEXTURE_SET 1u      // the second set of texture coordinates
#define LR_TEXTURE_NEAREST 2u  // no blending of texels
#define LR_TEXTURE_WRAP_U 4u   // shift of 2 bits: 0 repeat, 1 mirror, 2 clamp
#define LR_TEXTURE_WRAP_V 6u
struct MaterialConstants {
    vec4 base_color;
    vec4 emissive;  // and the cutoff of alpha
    vec4 surface;   // metallic, roughness, scale of the normal map, occlusion
    uvec4 flags;    // LR_MATERIAL_*
    TextureConstants base, metallic_roughness, normal, occluding, emitting;
};
#define LR_MATERIAL_DOUBLE_SIDED 1u
#define LR_MATERIAL_UNLIT 2u
#define LR_MATERIAL_MASK 4u
#define LR_MATERIAL_BLEND 8u
#define LR_MATERIAL_FLAT 16u

// The picture of triangle numbers: 0 is the background, else the original triangle + 1 and which side of it is seen.
#define LR_FRONT_FLAG 0x80000000u

// What a triangle is to the ring (paper: section 4.3, section 5), one byte a slot.
#define LR_CLASS_NONE 0u  // degenerate
#define LR_CLASS_T0 1u    // no ring edge
#define LR_CLASS_T1_LEFT 2u
#define LR_CLASS_T1_RIGHT 3u
#define LR_CLASS_T2 4u       // two ring edges, or three
#define LR_CLASS_T0_WART 5u  // a T0 that is stored in the redundant copy of a T2
#define LR_CLASS_T2_WART 6u  // that T2

// In the view of offsets a slot's byte is the significant bits of its offset along the ring, 1 to 31, or one of these.
#define LR_OFFSET_NONE 0u  // degenerate, or a tip on no ring
#define LR_OFFSET_T0 255u  // verbatim

#ifdef __cplusplus
}  // namespace lacedring::gpu
#endif
#endif
