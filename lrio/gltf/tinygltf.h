#pragma once
// tinygltf, built into lrio in a namespace of its own. Internal to lrio.
//
// libdraco exports a tinygltf of its own, which decodes Draco's data with few checks. In a program linked with libdraco
// and libtinygltf, the first in the link's order is called for both.

#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_FS
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define tinygltf lacedring_tinygltf

#include <tiny_gltf.h>
