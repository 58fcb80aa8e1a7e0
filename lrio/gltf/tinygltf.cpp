#include <fstream>  // tinygltf's writer wants it even where it opens no files

#define TINYGLTF_IMPLEMENTATION
#include "lrio/gltf/tinygltf.h"
