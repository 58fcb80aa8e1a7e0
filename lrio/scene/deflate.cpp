#include "lrio/scene/deflate.h"

#include <zlib.h>

#include <algorithm>
#include <memory>

#include "lrio/mesh/read_formats.h"

namespace lacedring::detail {

Result<std::vector<std::byte>> deflate_bytes(std::span<const std::byte> bytes) {
    if (bytes.size() > UINT32_MAX) return Error{ErrorCode::too_large, "more than 4 GiB to deflate"};
    uLongf size = compressBound(static_cast<uLong>(bytes.size()));
    std::vector<std::byte> out(size);
    const int done = compress2(reinterpret_cast<Bytef*>(out.data()), &size,
                               reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uLong>(bytes.size()), 9);
    if (done != Z_OK) return Error{ErrorCode::too_large, "zlib has no memory"};
    out.resize(size);
    return out;
}

Result<std::vector<std::byte>> inflate_bytes(std::span<const std::byte> bytes, std::uint64_t most, ErrorCode beyond) {
    if (bytes.size() > UINT32_MAX) return malformed("a zlib stream of more than 4 GiB");
    z_stream stream{};
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(bytes.data()));  // zlib's interface has no const
    stream.avail_in = static_cast<uInt>(bytes.size());
    if (inflateInit(&stream) != Z_OK) return Error{ErrorCode::too_large, "zlib has no memory"};
    const auto end = [](z_stream* open) { inflateEnd(open); };
    const std::unique_ptr<z_stream, decltype(end)> ended(&stream, end);  // memory may run out below
    std::vector<std::byte> out;
    std::size_t done = 0;
    int state = Z_OK;
    while (state == Z_OK) {
        if (done == out.size()) {  // doubles the buffer: memory grows only with decoded bytes
            if (done > most) break;
            out.resize(std::clamp<std::size_t>(2 * done, std::size_t{4} * bytes.size() + 64, std::size_t{1} << 40));
        }
        const std::size_t room = std::min<std::size_t>(out.size() - done, UINT32_MAX);
        stream.next_out = reinterpret_cast<Bytef*>(out.data() + done);
        stream.avail_out = static_cast<uInt>(room);
        state = inflate(&stream, Z_NO_FLUSH);
        done += room - stream.avail_out;
    }
    const bool whole = state == Z_STREAM_END && stream.avail_in == 0;
    if (done > most) return Error{beyond, fmt::format("a zlib stream of more than {} bytes", most)};
    if (!whole) return malformed("no sound zlib stream");
    out.resize(done);
    return out;
}

}  // namespace lacedring::detail
