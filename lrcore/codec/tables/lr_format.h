#pragma once
// The words of the standard LR tables. Paper: LR 2011, sections 4.4, 4.5 and 5.
//
// L and R lie side by side: word 2v is v.l, word 2v+1 is v.r. A word is a vertex and four bits that say what the slot
// is. The paper infers two of these from the references (a redundant T2, a border); here they are said, so that the
// tables stay right where two edges have the same ends, as they do on surfaces of high genus and wherever a
// non-manifold mesh was made manifold.

#include <cstdint>

namespace lr::word {

constexpr std::uint32_t kTip = 0x0fffffff;   ///< the tip vertex, or where an irregular triangle begins in VO*
constexpr std::uint32_t kWart = 0x80000000;  ///< T0w: the ring edge skips the tip of the T2w that comes next
constexpr std::uint32_t kIrregular =
    0x40000000;                                 ///< Ti: VO* holds the tip and the opposites of the start and end corner
constexpr std::uint32_t kFlip = 0x20000000;     ///< the input has this triangle the other way round
constexpr std::uint32_t kSpecial = 0x10000000;  ///< no triangle of its own; the other three bits say why:

constexpr std::uint32_t kRedundant = kSpecial;            ///< first copy of a T2; the tip is v.n.n
constexpr std::uint32_t kBorder = kSpecial | kIrregular;  ///< no triangle on this side
constexpr std::uint32_t kClosing = kSpecial | kWart;  ///< redundant, left only: the ring's last; the tip is its first
constexpr std::uint32_t kKind = kWart | kIrregular | kSpecial;

constexpr std::uint32_t kT0Flip = 0x80000000;  ///< on the first vertex of a T0 in VO: as kFlip

}  // namespace lr::word
