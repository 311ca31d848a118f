// What users call each built-in shape and its members, in one table: the keys of a scene, `drape keys`,
// `drape list shapes`, `drape drop --onto` and the Python classes are made of it. A built-in shape of
// constraints/shape.h that has no entry here does not compile. Meshes and level sets are read from files and
// have no entry.
#pragma once

#include <algorithm>
#include <tuple>
#include <type_traits>
#include <vector>

#include "app/base/table.h"
#include "constraints/shape.h"

namespace drape::app {

// place      a point [m], which goes with the shape when it is moved
// direction  a vector of any length but zero
// size       a length or three [m], greater than zero
// rounding   a length [m], not negative
// turn       a rotation, which is `rotate` in a scene
enum class Measure { place, direction, size, rounding, turn };

template <class Kind, class Value>
struct Field {
  const char* name;  // in a scene and in Python
  Value Kind::*member;
  Measure measure;
  const char* about;
  bool required = false;  // in a scene; an optional member keeps its default

  const char* key() const { return measure == Measure::turn ? "rotate" : name; }  // in a scene
};

template <class Kind, class Value>
Field(const char*, Value Kind::*, Measure, const char*) -> Field<Kind, Value>;
template <class Kind, class Value>
Field(const char*, Value Kind::*, Measure, const char*, bool) -> Field<Kind, Value>;

inline constexpr bool required = true;

using Sizes = std::vector<double>;  // m

// What --onto takes after the colon.
struct Onto {
  const char* example;
  const char* sizes;  // "radius x length"
  std::size_t least, most;
};

// The description of a shape. `python` names its class, `what` describes it in words, and of_sizes() makes
// the shape of --onto, about the origin.
template <class Kind>
struct Described;

template <>
struct Described<Plane> {
  static constexpr const char* python = "Plane";
  static constexpr const char* what = "the half space that the normal points away from";
  static constexpr std::tuple fields{
      Field{"point", &Plane::point, Measure::place, "any point of it"},
      Field{"normal", &Plane::normal, Measure::direction, "to the side of the cloth; of any length"}};
  static constexpr Onto onto{"plane", "", 0, 0};
  static Plane of_sizes(const Sizes&) { return {}; }
};

template <>
struct Described<Sphere> {
  static constexpr const char* python = "Sphere";
  static constexpr const char* what = "a ball";
  static constexpr std::tuple fields{Field{"centre", &Sphere::centre, Measure::place, "its middle"},
                                     Field{"radius", &Sphere::radius, Measure::size, "its size", required}};
  static constexpr Onto onto{"sphere:0.3", "radius", 1, 1};
  static Sphere of_sizes(const Sizes& s) { return {.radius = s[0]}; }
};

template <>
struct Described<Bowl> {
  static constexpr const char* python = "Bowl";
  static constexpr const char* what = "a hemispherical shell with a rounded rim, open along the axis";
  static constexpr std::tuple fields{
      Field{"centre", &Bowl::centre, Measure::place, "of the half sphere"},
      Field{"radius", &Bowl::radius, Measure::size, "of its inside", required},
      Field{"thickness", &Bowl::thickness, Measure::size, "of its wall, outwards"},
      Field{"axis", &Bowl::axis, Measure::direction, "to the side that is open"}};
  static constexpr Onto onto{"bowl:0.3x0.02", "radius x thickness", 1, 2};
  static Bowl of_sizes(const Sizes& s) {
    return {.radius = s[0], .thickness = s.size() > 1 ? s[1] : Bowl().thickness};
  }
};

template <>
struct Described<Box> {
  static constexpr const char* python = "Box";
  static constexpr const char* what = "a box with sharp edges";
  static constexpr std::tuple fields{
      Field{"centre", &Box::centre, Measure::place, "its middle, about which it is turned"},
      Field{"size", &Box::size, Measure::size, "its edges", required},
      Field{"rotation", &Box::rotation, Measure::turn, "its edges as columns"}};
  static constexpr Onto onto{"box:1x0.5x1", "width x height x depth", 3, 3};
  static Box of_sizes(const Sizes& s) { return {.size = {s[0], s[1], s[2]}}; }
};

template <>
struct Described<Capsule> {
  static constexpr const char* python = "Capsule";
  static constexpr const char* what = "all that is within a radius of the line from a to b";
  static constexpr std::tuple fields{
      Field{"a", &Capsule::a, Measure::place, "one end of its axis", required},
      Field{"b", &Capsule::b, Measure::place, "the other end", required},
      Field{"radius", &Capsule::radius, Measure::size,
            "round the axis and of the half spheres beyond its ends", required}};
  static constexpr Onto onto{"capsule:0.1x0.6", "radius x length, lying along x", 2, 2};
  static Capsule of_sizes(const Sizes& s) {
    const Vec3 half = 0.5 * s[1] * Vec3::UnitX();
    return {-half, half, s[0]};
  }
};

// With only its first size, the plate of --onto is as high as that of a drape test, and its rim is rounded by
// 5 mm as far as there is room.
template <>
struct Described<Plate> {
  static constexpr const char* python = "Plate";
  static constexpr const char* what = "a cylinder with rounded rims, the plate of drape tests";
  static constexpr std::tuple fields{
      Field{"centre", &Plate::centre, Measure::place, "its middle"},
      Field{"radius", &Plate::radius, Measure::size, "of the cylinder, with its rim", required},
      Field{"height", &Plate::height, Measure::size, "along the axis"},
      Field{"rim", &Plate::rim, Measure::rounding,
            "radius to which its two rims are rounded: at most its radius and half its height; 0 is sharp"},
      Field{"axis", &Plate::axis, Measure::direction, "of the cylinder"}};
  static constexpr Onto onto{"plate:0.09", "radius x height x rim; 0.02 m high, 0.005 m of rim", 1, 3};
  static Plate of_sizes(const Sizes& s) {
    Plate plate{.radius = s[0], .height = s.size() > 1 ? s[1] : Plate().height};
    plate.rim = s.size() > 2 ? s[2] : std::min({0.005, plate.radius, plate.height / 2});
    return plate;
  }
};

template <class Kind>
inline constexpr bool from_file = std::is_same_v<Kind, MeshBody> || std::is_same_v<Kind, DeformingBody> ||
                                  std::is_same_v<Kind, LevelSetBody>;

// Calls f(Sphere()), f(Bowl()) and so on, once for each built-in shape with its defaults.
template <class F, class... Kinds>
void for_each_built_in(const F& f, std::type_identity<std::variant<Kinds...>>) {
  const auto unless_from_file = [&]<class Kind>() {
    if constexpr (!from_file<Kind>) f(Kind());
  };
  (unless_from_file.template operator()<Kinds>(), ...);
}
template <class F>
void for_each_built_in(const F& f) {
  for_each_built_in(f, std::type_identity<Shape>());
}

// Calls f(field) for each member of the shape.
template <class Kind, class F>
void for_each_field(const F& f) {
  std::apply([&](const auto&... field) { (f(field), ...); }, Described<Kind>::fields);
}

}  // namespace drape::app
