/* Tests scene.h: scene PACKED.glb PLAIN.glb, where PLAIN.glb was written by `lacedring unpack PACKED.glb`. */
#include "lacedring/scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int failures = 0;
#define EXPECT(condition) \
    ((condition) ? (void)0 : (void)(++failures, printf("%s:%d: %s\n", __FILE__, __LINE__, #condition)))

static unsigned char* read_all(const char* name, size_t* size) {
    FILE* file = fopen(name, "rb");
    unsigned char* bytes = NULL;
    size_t room = 0;
    *size = 0;
    if (file == NULL) return NULL;
    while (!feof(file) && !ferror(file)) {
        unsigned char* more = realloc(bytes, room += 65536);
        if (more == NULL) break;
        bytes = more;
        *size += fread(bytes + *size, 1, room - *size, file);
    }
    fclose(file);
    return bytes;
}

static void check_good(const unsigned char* packed, size_t packed_size, const unsigned char* plain, size_t plain_size) {
    unsigned char *glb = NULL, *again = NULL;
    size_t size = 0, again_size = 0;
    struct lacedring_message message = {""};
    EXPECT(lacedring_is_packed_scene(packed, packed_size) == 1);
    EXPECT(lacedring_is_packed_scene(plain, plain_size) == 0);
    EXPECT(lacedring_unpack_scene(packed, packed_size, 0, &glb, &size, &message) == LACEDRING_CODE_OK);
    EXPECT(message.text[0] == 0);
    EXPECT(size == plain_size && glb != NULL && memcmp(glb, plain, size) == 0);
    /* A scene that is not packed is returned with its buffer views in order. */
    EXPECT(lacedring_unpack_scene(glb, size, 0, &again, &again_size, NULL) == LACEDRING_CODE_OK);
    EXPECT(again != NULL && lacedring_is_packed_scene(again, again_size) == 0);
    lacedring_free(glb);
    lacedring_free(again);
    lacedring_free(NULL);
}

/* Errors set the results to null. */
static void check_error(enum lacedring_code wanted, const void* bytes, size_t size, uint64_t max_bytes) {
    unsigned char* glb = (unsigned char*)&failures;
    size_t glb_size = 1;
    struct lacedring_message message = {""};
    EXPECT(lacedring_unpack_scene(bytes, size, max_bytes, &glb, &glb_size, &message) == wanted);
    EXPECT(glb == NULL && glb_size == 0 && message.text[0] != 0);
    EXPECT(strchr(message.text, '\n') == NULL);
}

int main(int argc, char** argv) {
    static const char elsewhere[] =
        "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":4,\"uri\":\"a.bin\"}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":4}]}";
    size_t packed_size = 0, plain_size = 0, cut, one = 0;
    unsigned char *packed = argc == 3 ? read_all(argv[1], &packed_size) : NULL,
                  *plain = argc == 3 ? read_all(argv[2], &plain_size) : NULL, *glb = NULL;
    if (packed == NULL || plain == NULL) return printf("scene PACKED.glb PLAIN.glb\n"), 2;
    check_good(packed, packed_size, plain, plain_size);

    check_error(LACEDRING_CODE_INVALID_ARGUMENT, NULL, 0, 0);
    EXPECT(lacedring_unpack_scene(packed, packed_size, 0, NULL, &one, NULL) == LACEDRING_CODE_INVALID_ARGUMENT);
    EXPECT(lacedring_unpack_scene(packed, packed_size, 0, &glb, NULL, NULL) == LACEDRING_CODE_INVALID_ARGUMENT);
    EXPECT(lacedring_is_packed_scene(NULL, 0) == 0);
    EXPECT(lacedring_is_packed_scene("solid", 5) == 0);
    check_error(LACEDRING_CODE_MALFORMED, "solid", 5, 0);
    check_error(LACEDRING_CODE_OUT_OF_MEMORY, packed, packed_size, 1024);
    check_error(LACEDRING_CODE_MALFORMED, elsewhere, sizeof elsewhere - 1, 0); /* no file is opened */
    for (cut = 0; cut < packed_size; cut += 1 + packed_size / 97) {
        unsigned char* exact = malloc(cut + 1);
        if (exact == NULL) return 2;
        memcpy(exact, packed, cut);
        check_error(LACEDRING_CODE_MALFORMED, exact, cut, 0);
        free(exact);
    }
    free(packed);
    free(plain);
    printf("%d failures\n", failures);
    return failures != 0;
}
