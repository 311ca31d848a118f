#include "app/picture/picture.h"

#include "mesh/obj.h"

namespace drape {

int picture(const PictureWords& words) { throw InputError(words.input + ": pictures are not in this build"); }

}  // namespace drape
