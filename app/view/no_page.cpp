// In place of what is bundled where it could not be.
#include "app/view/page_template.h"

namespace drape::app {

std::string_view page_template() { return {}; }
std::string_view plot_style() { return {}; }
std::string_view plot_script() { return {}; }

}  // namespace drape::app
