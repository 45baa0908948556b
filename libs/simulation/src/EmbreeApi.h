// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The only place that depends on Embree's version: version 3 (Debian 12) passes a context, version 4 (Debian 13)
// arguments.
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace lintel {

/// First hits of eight rays that lie near each other.
inline void intersectPacket(const int* valid, RTCScene scene, RTCRayHit8& query) {
#if RTC_VERSION_MAJOR >= 4
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  rtcIntersect8(valid, scene, &query, &arguments);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect8(valid, scene, &context, &query);
#endif
}

/// Whether anything lies on the ray: then its tfar is negative.
inline void testOcclusion(RTCScene scene, RTCRay& ray) {
#if RTC_VERSION_MAJOR >= 4
  rtcOccluded1(scene, &ray, nullptr);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene, &context, &ray);
#endif
}

}  // namespace lintel
