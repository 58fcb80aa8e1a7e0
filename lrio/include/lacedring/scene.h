/* Packed glTF scenes in C99: what `lacedring pack` writes, or pack_scene (scene.hpp), into plain glTF. Link with
   lacedring::io.

   Codes and messages are those of lacedring.h; nothing here prints, exits or throws, no file is opened, and functions
   may be called from several threads at once. Untrusted input is safe. */
#ifndef LACEDRING_SCENE_H
#define LACEDRING_SCENE_H

#include <stddef.h>
#include <stdint.h>

#include "lacedring/lacedring.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Does the glTF or GLB have the extension LACEDRING_mesh_compression? Of bytes that are no glTF: 0. Cost: O(the JSON),
   in up to 32 times its bytes of memory; 0 where there is not so much. */
int lacedring_is_packed_scene(const void* bytes, size_t size);

/* Plain GLB of a packed GLB, or of a packed glTF whose buffers are `data:` URIs. Of one that is not packed: the same
   with one buffer. `max_bytes`: of memory that what is decoded may take; 0: 512 MiB, or 128 times `size` where that is
   more. The bytes need not stay. On success *glb is the file, *glb_size bytes, for lacedring_free; on an error *glb is
   null and *glb_size 0. `message` may be null. Errors: MALFORMED (no glTF; streams that do not follow their format; a
   part of glTF that is not read; a buffer in a file of its own), INVALID_ARGUMENT (a null pointer), TOO_LARGE (4 GiB;
   the machine's memory), OUT_OF_MEMORY (`max_bytes`). Cost: O(the plain file). */
enum lacedring_code lacedring_unpack_scene(const void* bytes, size_t size, uint64_t max_bytes, unsigned char** glb,
                                           size_t* glb_size, struct lacedring_message* message);

/* Frees what a function of this header returned. Null: does nothing. */
void lacedring_free(void* memory);

#ifdef __cplusplus
}
#endif
#endif /* LACEDRING_SCENE_H */
