#include "app/picture/render.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "app/picture/surface.h"
#include "mesh/base/parallel.h"

namespace drape::app::drawing {
namespace {

constexpr int margin = 4;              // samples round a tile: half of the largest window that is averaged
constexpr int small_picture = 700000;  // pixels: up to here there is time for four times as many rays
constexpr int tile = 64;               // pixels
constexpr int tile_samples = 2 * tile + 2 * margin;
constexpr double light_spread = 0.16;    // radius of the light over its distance
constexpr double occlusion_reach = 0.3;  // of the scene's size
// Where in a pixel its four samples are: no two in one row or column of quarters.
constexpr double sample_x[2][2] = {{0.375, 0.875}, {0.125, 0.625}};  // [row][column]
constexpr double sample_y[2][2] = {{0.125, 0.375}, {0.625, 0.875}};

// How light falls on what shows colours of cloths, and on colours that a legend
// explains: flatter, to be read.
struct Lights {
  float key, sky, fill;
};
constexpr Lights plain = {1.0F, 0.36F, 0.10F}, legible = {0.42F, 0.50F, 0.20F};
constexpr float occluded = 0.88F;  // the rest is light that walls throw back
constexpr double border = 0.2;     // of the sides
constexpr float ground_tone = 0.96F, ground_key = 0.45F;

// Directions and places of the light that the samples of a window ask for: 64 points spread over the unit
// square (Hammersley), handed out in the order of Bayer's matrix, so that neighbours get distant ones.
struct Pattern {
  std::array<Eigen::Vector2d, 64> disc;  // unit disc
  std::array<Vec3, 64> half_sphere;      // about z, denser round it by the cosine

  Pattern() {
    for (unsigned y = 0; y < 8; ++y)
      for (unsigned x = 0; x < 8; ++x) {
        unsigned rank = 0, mirrored = 0;
        for (unsigned bit = 0; bit < 3; ++bit) {
          const unsigned bx = x >> bit & 1U, by = y >> bit & 1U;
          rank = rank << 2U | (bx ^ by) << 1U | by;
        }
        for (unsigned bit = 0; bit < 6; ++bit) mirrored |= (rank >> bit & 1U) << (5 - bit);
        const double u = (rank + 0.5) / 64, turn = 2 * std::numbers::pi * (mirrored + 0.5) / 64;
        const double r = std::sqrt(u);
        disc[8 * y + x] = {r * std::cos(turn), r * std::sin(turn)};
        half_sphere[8 * y + x] = {r * std::cos(turn), r * std::sin(turn), std::sqrt(1 - u)};
      }
  }
};
const Pattern pattern;

struct Sample {
  Seen seen;
  float shadow = 0, occlusion = 0;  // shares of its own rays that met something
};

class Painter {
 public:
  Painter(const Still& still, const Camera& camera, const Look& look, Image& image, const PixelBox& box)
      : surface_(still, look),
        still_(still),
        camera_(camera),
        look_(look),
        image_(image),
        left_(static_cast<int>(box.x)),
        top_(static_cast<int>(box.y)),
        width_(static_cast<int>(box.width)),
        height_(static_cast<int>(box.height)),
        window_(image.width * image.height > small_picture ? 8 : 4) {
    key_ = (-0.65 * camera.right + 0.80 * Vec3::UnitY() + 0.60 * camera.toward).normalized();
    across_ = key_.unitOrthogonal();
    along_ = key_.cross(across_);
  }

  void paint() const {
    const int columns = (width_ + tile - 1) / tile, rows = (height_ + tile - 1) / tile;
    parallel_for(columns * rows, false, [&](int k) { paint_tile(k % columns * tile, k / columns * tile); });
  }

 private:
  using Samples = std::vector<Sample>;

  // x and y count pixels of the box, sx and sy samples of it.
  void paint_tile(int x, int y) const {
    Samples samples(static_cast<std::size_t>(tile_samples) * tile_samples);
    bool empty = true;
    for (int j = 0; j < tile_samples; ++j)
      for (int i = 0; i < tile_samples; ++i) {
        Sample& sample = samples[j * tile_samples + i];
        look_through(sample, 2 * x - margin + i, 2 * y - margin + j);
        empty = empty && sample.seen.part == -1;
      }
    if (empty) return;
    for (int py = 0; py < tile && y + py < height_; ++py)
      for (int px = 0; px < tile && x + px < width_; ++px) {
        Light sum = Light::Zero();
        bool nothing = true;
        for (int k = 0; k < 4; ++k) {
          const int at = (margin + 2 * py + k / 2) * tile_samples + margin + 2 * px + k % 2;
          nothing = nothing && samples[at].seen.part == -1;
          sum += lit(samples, at);
        }
        if (!nothing) image_.at(left_ + x + px, top_ + y + py) = pixel(sum / 4);
      }
  }

  void look_through(Sample& sample, int sx, int sy) const {
    const int row = sy & 1, column = sx & 1;
    const int px = (sx - column) / 2, py = (sy - row) / 2;  // the pixel that it belongs to
    const Vec3 direction =
        camera_.direction(left_ + px + sample_x[row][column], top_ + py + sample_y[row][column]);
    sample.seen = surface_.seen(camera_.eye, direction, camera_.slope);
    if (sample.seen.part == -1) return;
    if (sample.seen.part <= -2) sample.seen.fade *= near_border(sx / 2, sy / 2);
    for (int dy = 0; dy < 8; dy += window_)
      for (int dx = 0; dx < 8; dx += window_)
        ask(sample, static_cast<std::size_t>(8 * ((sy & (window_ - 1)) + dy) + (sx & (window_ - 1)) + dx));
  }

  void ask(Sample& sample, std::size_t place) const {
    const float share = static_cast<float>(window_ * window_) / 64;
    const Vec3 normal = sample.seen.normal.cast<double>();
    const Eigen::Vector2d off = light_spread * pattern.disc[place];
    const Vec3 to_light = key_ + off.x() * across_ + off.y() * along_;
    if (normal.dot(to_light) > 0 && surface_.blocked(sample.seen.from, to_light.normalized(), 4 * look_.size))
      sample.shadow += share;
    const Vec3 outwards = frame_of(normal) * pattern.half_sphere[place];
    if (surface_.covered(sample.seen.from, outwards, occlusion_reach * look_.size)) sample.occlusion += share;
  }

  // What a sample shows, with what it and its neighbours on the same surface have learnt.
  Light lit(const Samples& samples, int at) const {
    const Seen& seen = samples[at].seen;
    static const Light nothing = light(background);
    if (seen.part == -1) return nothing;
    const double thick = 6 * camera_.slope * seen.distance;  // m
    float shadow = 0, occlusion = 0, count = 0;
    for (int j = -window_ / 2; j < window_ / 2; ++j)
      for (int i = -window_ / 2; i < window_ / 2; ++i) {
        const Sample& other = samples[at + j * tile_samples + i];
        if (other.seen.part != seen.part || other.seen.normal.dot(seen.normal) < 0.75F ||
            std::abs((other.seen.point - seen.point).dot(seen.normal.cast<double>())) > thick)
          continue;
        shadow += other.shadow, occlusion += other.occlusion, count += 1;
      }
    shadow /= count, occlusion /= count;
    if (seen.part <= -2) return on_ground(seen, shadow, occlusion);
    const bool explained = look_.scale && !still_.parts[seen.part].values.empty();
    const Lights& lights = explained ? legible : plain;
    const Eigen::Vector3f l = key_.cast<float>(), e = (camera_.eye - seen.point).normalized().cast<float>();
    const float from_above = 0.8F + 0.2F * seen.normal.y();
    return seen.colour * (lights.key * std::max(0.0F, seen.normal.dot(l)) * (1 - shadow) +
                          lights.sky * (1 - occluded * occlusion) * from_above +
                          lights.fill * std::max(0.0F, seen.normal.dot(e)) * (1 - 0.5F * occlusion));
  }

  // Axes whose third is the normal. They turn as little as can be from one normal to the next, so that
  // neighbours ask for different directions: singular only where the normal points away from the viewer
  // [Duff et al. 2017, Building an orthonormal basis, revisited].
  Mat3 frame_of(const Vec3& normal) const {
    Mat3 axes, turned;
    axes << camera_.right, camera_.up, camera_.toward;
    const Vec3 n = axes.transpose() * normal;
    const double a = -1 / (1 + std::max(n.z(), -0.9)), b = n.x() * n.y() * a;
    turned << 1 + a * n.x() * n.x(), b, n.x(), b, 1 + a * n.y() * n.y(), n.y(), -n.x(), -n.y(), n.z();
    return axes * turned;
  }

  // 0 at the border of the box, 1 some way in: the ground has no edge.
  float near_border(int x, int y) const {
    const auto fade = [](double depth, double size) {
      const double t = std::clamp(depth / (border * size), 0.0, 1.0);
      return t * t * (3 - 2 * t);
    };
    return static_cast<float>(fade(std::min(x, width_ - 1 - x), width_) *
                              fade(std::min(y, height_ - 1 - y), height_));
  }

  // The ground is the background, a little darker, where nothing keeps the light from it.
  static Light on_ground(const Seen& seen, float shadow, float occlusion) {
    const float tone = ground_tone * (1 - ground_key * shadow) * (1 - (1 - ground_key) * occlusion);
    return light(background) * (1 - seen.fade * (1 - tone));
  }

  Surface surface_;
  const Still& still_;
  const Camera& camera_;
  const Look& look_;
  Image& image_;
  int left_, top_, width_, height_;
  int window_;                 // samples: what is averaged, and the period of the pattern
  Vec3 key_, across_, along_;  // to the light, unit, and across
};

}  // namespace

void render(const Still& still, const Camera& camera, const Look& look, Image& image, const PixelBox& box) {
  Painter(still, camera, look, image, box).paint();
}

}  // namespace drape::app::drawing
