// Makes one visitor of several lambdas:
//   std::visit(Match{[](const Plane& p) {...}, [](const Sphere& s) {...}}, shape)
#pragma once

namespace drape {

template <class... Cases>
struct Match : Cases... {
  using Cases::operator()...;
};
template <class... Cases>
Match(Cases...) -> Match<Cases...>;

}  // namespace drape
