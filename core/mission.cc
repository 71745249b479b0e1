#include "core/mission.h"

#include "core/noise.h"

namespace ergocast {

Eigen::Vector2d start_of(const Mission& mission, AgentId id) {
  const auto at = static_cast<std::size_t>(id);
  return at < mission.starts_m.size() ? mission.starts_m[at]
                                      : random_start(mission.domain, mission.seed, id);
}

Eigen::Vector2d random_start(const Rectangle& domain, std::uint64_t seed, AgentId id) {
  const Eigen::Vector2d share =
      uniform_pair(seed, Purpose::kStart, static_cast<std::uint32_t>(id), 0);
  return domain.origin_m + share.cwiseProduct(domain.size_m);
}

}  // namespace ergocast
