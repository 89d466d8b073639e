// What the invocations that decide a pixel's list say to each other (visibility/exact/team.glsl), by subgroups and
// without, against closed forms. `resolve` and `resolve long` by subgroups differ from the others in this alone, and
// run only on devices whose subgroups are of 32; here teams are as large as the device's subgroups.
#include "host/kernel.h"
#include "shaders/team_16.spv.h"
#include "shaders/team_32.spv.h"
#include "shaders/team_4.spv.h"
#include "shaders/team_8.spv.h"
#include "shaders/team_subgroups_16.spv.h"
#include "shaders/team_subgroups_32.spv.h"
#include "shaders/team_subgroups_4.spv.h"
#include "shaders/team_subgroups_8.spv.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <span>
#include <vector>

namespace gpgp {
namespace {

struct Said {
  uint32_t value, lane, flag;
};
using Heard = std::array<uint32_t, 12>;

constexpr uint32_t kTeams = 64;

std::vector<Said> talk(uint32_t size) {
  std::mt19937 random(size);
  std::vector<Said> said(kTeams * size);
  for (uint32_t i = 0; i < said.size(); ++i) {
    const uint32_t team = i / size, few = static_cast<uint32_t>(random()) >> (team % 32), lane = i % size;
    said[i] = {team == 0   ? 0u
               : team == 1 ? ~0u
               : team == 2 ? lane
                           : few,
               team == 2 ? size - 1 - lane : static_cast<uint32_t>(random()) % size,
               team == 0   ? 0u
               : team == 1 ? 1u
                           : static_cast<uint32_t>(random()) & 1u};
  }
  return said;
}

Heard expected(std::span<const Said> team, uint32_t lane) {
  Heard heard{0, 0, ~0u, 0, 0};
  for (uint32_t i = 0; i < team.size(); ++i) {
    heard[0] |= team[i].flag << i;
    heard[1] |= team[i].value;
    heard[2] = std::min(heard[2], team[i].value);
    heard[3] = std::max(heard[3], team[i].value);
    if (i <= lane) heard[4] += team[i].value;
  }
  const uint32_t v = team[team[lane].lane].value;
  const uint32_t others[] = {v, v, ~v, v, v ^ 1, v ^ 2, v ^ 4};
  std::copy(std::begin(others), std::end(others), heard.begin() + 5);
  return heard;
}

void expectHeard(host::HeadlessDevice& device, std::span<const uint32_t> shader, uint32_t size) {
  const std::vector<Said> said = talk(size);
  const auto input = host::makeBuffer(device, said, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  const host::Buffer output(device, said.size() * sizeof(Heard), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  host::ComputeKernel kernel(device, shader, 2);
  kernel.run({&input, &output}, nullptr, kTeams);
  const auto heard = host::download<Heard>(device, output, said.size());
  for (uint32_t i = 0; i < said.size(); ++i)
    ASSERT_EQ(heard[i], expected({&said[i - i % size], size}, i % size)) << "team " << i / size << ", " << i % size;
  for (const std::string& message : device.validationMessages()) ADD_FAILURE() << message;
}

uint32_t subgroupSize(const host::HeadlessDevice& device) {
  VkPhysicalDeviceSubgroupProperties subgroups{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES};
  VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &subgroups};
  vkGetPhysicalDeviceProperties2(device.physicalDevice(), &properties);
  return subgroups.subgroupSize;
}

TEST(Team, HearsEachOtherThroughSharedMemory) {
  host::HeadlessDevice device(host::DeviceOptions{.validation = true});
  expectHeard(device, team_4, 4);
  expectHeard(device, team_8, 8);
  expectHeard(device, team_16, 16);
  expectHeard(device, team_32, 32);
}

TEST(Team, HearsEachOtherBySubgroups) {
  host::HeadlessDevice device(host::DeviceOptions{.validation = true});
  switch (subgroupSize(device)) {
  case 4: return expectHeard(device, team_subgroups_4, 4);
  case 8: return expectHeard(device, team_subgroups_8, 8);
  case 16: return expectHeard(device, team_subgroups_16, 16);
  case 32: return expectHeard(device, team_subgroups_32, 32);
  default: GTEST_SKIP() << "no team has as many invocations as this device's subgroups";
  }
}

} // namespace
} // namespace gpgp
