#pragma once
// tinygltf, built into lrio in its own namespace. Internal to lrio.
//
// libdraco exports its own tinygltf, which decodes Draco data with few checks. Without the namespace, a program linked
// with libdraco might call that one.

#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_FS
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define tinygltf lacedring_tinygltf

#include <tiny_gltf.h>
