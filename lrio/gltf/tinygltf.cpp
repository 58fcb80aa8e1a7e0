#include <fstream>  // tinygltf's writer needs it even if it opens no files

#define TINYGLTF_IMPLEMENTATION
#include "lrio/gltf/tinygltf.h"
