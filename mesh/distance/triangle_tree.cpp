#include "mesh/distance/triangle_tree.h"

#include <embree3/rtcore.h>

#include <limits>
#include <stdexcept>

namespace drape {

struct TriangleTree::Embree {
  std::unique_ptr<RTCDeviceTy, decltype(&rtcReleaseDevice)> device{nullptr, rtcReleaseDevice};
  std::unique_ptr<RTCSceneTy, decltype(&rtcReleaseScene)> scene{nullptr, rtcReleaseScene};
};

void TriangleTree::Release::operator()(Embree* embree) const { delete embree; }

TriangleTree::TriangleTree(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                           const Vec3& centre, Quality quality)
    : embree_(new Embree), centre_(centre) {
  auto& [device, scene] = *embree_;
  device.reset(rtcNewDevice("threads=1"));
  if (!device) throw std::runtime_error("embree does not start on this processor");
  scene.reset(rtcNewScene(device.get()));
  rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(scene.get(),
                          quality == Quality::high ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM);
  const RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* place = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), positions.size()));
  auto* index = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), triangles.size()));
  if (place && index) {
    for (const Vec3& p : positions)
      for (int k = 0; k < 3; ++k) *place++ = static_cast<float>(p[k] - centre[k]);
    for (const Triangle& t : triangles)
      for (int v : t) *index++ = static_cast<unsigned>(v);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene.get(), geometry);
    rtcCommitScene(scene.get());
  }
  rtcReleaseGeometry(geometry);
  if (rtcGetDeviceError(device.get()) != RTC_ERROR_NONE)
    throw std::runtime_error("embree cannot hold the surface");
}

void TriangleTree::visit(const Vec3& x, float (*f)(void*, int, float), void* context) const {
  struct Call {
    float (*f)(void*, int, float);
    void* context;
  } call{f, context};
  const Vec3 local = x - centre_;
  RTCPointQuery ball{static_cast<float>(local.x()), static_cast<float>(local.y()),
                     static_cast<float>(local.z()), 0, std::numeric_limits<float>::infinity()};
  RTCPointQueryContext of_query;
  rtcInitPointQueryContext(&of_query);
  rtcPointQuery(
      embree_->scene.get(), &ball, &of_query,
      [](RTCPointQueryFunctionArguments* arguments) {
        const Call& c = *static_cast<const Call*>(arguments->userPtr);
        const float radius = c.f(c.context, static_cast<int>(arguments->primID), arguments->query->radius);
        if (radius >= arguments->query->radius) return false;
        arguments->query->radius = radius;
        return true;
      },
      &call);
}

namespace {

RTCRay ray_of(const Vec3& from, const Vec3& direction, double distance) {
  RTCRay ray{};
  ray.org_x = static_cast<float>(from.x());
  ray.org_y = static_cast<float>(from.y());
  ray.org_z = static_cast<float>(from.z());
  ray.dir_x = static_cast<float>(direction.x());
  ray.dir_y = static_cast<float>(direction.y());
  ray.dir_z = static_cast<float>(direction.z());
  ray.tfar = static_cast<float>(distance);
  ray.mask = ~0U;
  return ray;
}

}  // namespace

TriangleTree::Hit TriangleTree::first_hit(const Vec3& from, const Vec3& direction) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit found{ray_of(from - centre_, direction, std::numeric_limits<double>::infinity()), {}};
  found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(embree_->scene.get(), &context, &found);
  if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
  const double u = found.hit.u, v = found.hit.v;
  return {static_cast<int>(found.hit.primID), found.ray.tfar, {1 - u - v, u, v}};
}

bool TriangleTree::blocked(const Vec3& from, const Vec3& direction, double distance) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay ray = ray_of(from - centre_, direction, distance);
  rtcOccluded1(embree_->scene.get(), &context, &ray);
  return ray.tfar < 0;
}

}  // namespace drape
