// SPDX-License-Identifier: BSD-3-Clause
// PROJ's `aeqd`, made from its parameters alone: no database and no network is used.
#include "target/geo/local_plane.h"

#include <proj.h>

#include <cstdio>
#include <stdexcept>

namespace ergocast {

struct LocalPlane::Projection {
  PJ_CONTEXT* context = proj_context_create();
  PJ* projection = nullptr;

  Projection() = default;
  Projection(const Projection&) = delete;
  Projection& operator=(const Projection&) = delete;
  ~Projection() {
    proj_destroy(projection);
    proj_context_destroy(context);
  }
};

LocalPlane::LocalPlane(const GeoPlace& origin) : projection_(std::make_unique<Projection>()) {
  char text[160];
  std::snprintf(text, sizeof text, "+proj=aeqd +lat_0=%.17g +lon_0=%.17g +ellps=WGS84 +units=m",
                origin.latitude_deg, origin.longitude_deg);
  proj_context_set_enable_network(projection_->context, 0);
  projection_->projection = proj_create(projection_->context, text);
  if (projection_->projection == nullptr) {
    throw std::runtime_error(std::string("PROJ has no projection for ") + text);
  }
}

LocalPlane::~LocalPlane() = default;
LocalPlane::LocalPlane(LocalPlane&&) noexcept = default;
LocalPlane& LocalPlane::operator=(LocalPlane&&) noexcept = default;

Eigen::Vector2d LocalPlane::to_local_m(const GeoPlace& place) const {
  const PJ_COORD from =
      proj_coord(proj_torad(place.longitude_deg), proj_torad(place.latitude_deg), 0, 0);
  const PJ_COORD to = proj_trans(projection_->projection, PJ_FWD, from);
  return {to.xy.x, to.xy.y};
}

GeoPlace LocalPlane::to_place(const Eigen::Vector2d& x_m) const {
  const PJ_COORD from = proj_coord(x_m.x(), x_m.y(), 0, 0);
  const PJ_COORD to = proj_trans(projection_->projection, PJ_INV, from);
  return {proj_todeg(to.lp.phi), proj_todeg(to.lp.lam)};
}

}  // namespace ergocast
