/* C99 interface to unpack glTF scenes that `lacedring pack` or pack_scene (scene.hpp) wrote. Link with lacedring::io.

   Codes and messages are those of lacedring.h. The functions do not print, exit, throw or open files; several threads
   may call them at once. Untrusted input is safe. */
#ifndef LACEDRING_SCENE_H
#define LACEDRING_SCENE_H

#include <stddef.h>
#include <stdint.h>

#include "lacedring/lacedring.h"

#ifdef __cplusplus
extern "C" {
#endif

/* 1 if the glTF or GLB has the extension LACEDRING_mesh_compression, else 0; 0 also if the bytes are not glTF or memory
   is short. Cost: O(JSON), with up to 32 bytes of memory for each byte of JSON. */
int lacedring_is_packed_scene(const void* bytes, size_t size);

/* Unpacks a GLB, or a glTF whose buffers are `data:` URIs, to a plain GLB. An input that is not packed is rewritten
   with one buffer. `max_bytes` limits the memory of decoded data; 0: 512 MiB or 128 times `size`, whichever is more.
   `bytes` may be freed after the call. On success, *glb points to *glb_size bytes, which the caller frees with
   lacedring_free; on an error, *glb is null and *glb_size 0. `message` may be null. Errors: MALFORMED (no glTF; streams
   that violate their format; a part of glTF that is not read; a buffer in a separate file), INVALID_ARGUMENT (a null
   pointer), TOO_LARGE (4 GiB; the machine's memory), OUT_OF_MEMORY (`max_bytes`). Cost: O(plain file). */
enum lacedring_code lacedring_unpack_scene(const void* bytes, size_t size, uint64_t max_bytes, unsigned char** glb,
                                           size_t* glb_size, struct lacedring_message* message);

/* Frees the *glb of lacedring_unpack_scene. Null: does nothing. */
void lacedring_free(void* memory);

#ifdef __cplusplus
}
#endif
#endif /* LACEDRING_SCENE_H */
