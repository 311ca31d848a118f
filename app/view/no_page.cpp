// In place of the page where it could not be made.
#include "app/view/page_template.h"

namespace drape {

std::string_view page_template() { return {}; }

}  // namespace drape
