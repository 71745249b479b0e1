// SPDX-License-Identifier: BSD-3-Clause
// Times the cost of a mission key per message: protecting and verifying datagrams with and without
// a key. The lower bounds are only the hash, and only the signature, over as many bytes.
#include <benchmark/benchmark.h>
#include <sodium.h>

#include <array>
#include <vector>

#include "lcmtypes/channels.h"
#include "lcmtypes/codec.h"
#include "runtime/process/key_file.h"

namespace ergocast::bench {
namespace {

enum Kind { kCommandMessage, kContributionMessage, kMissionMessage };

Message message_of(std::int64_t kind) {
  const Header from{1, kind == kMissionMessage ? kCoordinator : 3, 5, 1, 9};
  if (kind == kCommandMessage) return Command{from, {1, 2, 0}, {3, 4, 0}};
  if (kind == kMissionMessage) {
    MissionPart part;
    part.header = from;
    part.plan.resize(kMaxPlanBytesPerMessage);
    part.roster.resize(kMaxRosterEntriesPerMessage);
    for (RosterEntry& entry : part.roster) entry.author = {0, 1};
    return part;
  }
  Contribution block;
  block.header = from;
  return block;
}

const MessageAuthenticator& authenticator_of(bool keyed) {
  static const MessageAuthenticator kAuthenticators[] = {MessageAuthenticator(),
                                                         MessageAuthenticator(make_mission_key())};
  return kAuthenticators[keyed];
}

void Close(benchmark::State& state) {
  const Message message = message_of(state.range(0));
  const MessageAuthenticator& authenticator = authenticator_of(state.range(1) != 0);
  const std::string& channel = channel_of(message);
  std::vector<std::byte> bytes;
  for (auto _ : state) {
    encode(message, bytes, authenticator, channel);
    benchmark::DoNotOptimize(bytes.data());
  }
  state.counters["bytes"] = static_cast<double>(bytes.size());
}

void Open(benchmark::State& state) {
  const Message message = message_of(state.range(0));
  const MessageAuthenticator& authenticator = authenticator_of(state.range(1) != 0);
  const std::string& channel = channel_of(message);
  std::vector<std::byte> bytes;
  encode(message, bytes, authenticator, channel);
  for (auto _ : state) {
    const auto decoded = decode(bytes, 1, authenticator, channel);
    if (!decoded) state.SkipWithError("refused");
    benchmark::DoNotOptimize(decoded);
  }
}

/// A forgery: its receiver computes only the tag.
void Refuse(benchmark::State& state) {
  const Message message = message_of(state.range(0));
  const std::string& channel = channel_of(message);
  std::vector<std::byte> bytes;
  encode(message, bytes);
  for (auto _ : state) {
    const auto decoded = decode(bytes, 1, authenticator_of(true), channel);
    if (decoded) state.SkipWithError("accepted");
    benchmark::DoNotOptimize(decoded);
  }
}

/// The lower bound: only libsodium's hash of these bytes.
void KeyedHashAlone(benchmark::State& state) {
  std::vector<std::byte> bytes;
  encode(message_of(state.range(0)), bytes);
  const std::array<unsigned char, 32> key{1};
  std::array<unsigned char, 16> tag;
  for (auto _ : state) {
    crypto_generichash(tag.data(), tag.size(), reinterpret_cast<const unsigned char*>(bytes.data()),
                       bytes.size(), key.data(), key.size());
    benchmark::DoNotOptimize(tag);
  }
}

/// The lower bound of a signed message: only libsodium's signature of these bytes, made or checked.
void SignatureAlone(benchmark::State& state) {
  std::vector<std::byte> bytes;
  encode(message_of(kMissionMessage), bytes);
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
  std::array<unsigned char, crypto_sign_PUBLICKEYBYTES> open_key;
  std::array<unsigned char, crypto_sign_SECRETKEYBYTES> secret_key;
  std::array<unsigned char, crypto_sign_BYTES> signature;
  crypto_sign_keypair(open_key.data(), secret_key.data());
  const auto sign = [&] {
    crypto_sign_detached(signature.data(), nullptr, data, bytes.size(), secret_key.data());
  };
  sign();
  const bool checks = state.range(0) != 0;
  for (auto _ : state) {
    if (!checks) sign();
    if (checks &&
        crypto_sign_verify_detached(signature.data(), data, bytes.size(), open_key.data()) != 0)
      state.SkipWithError("refused");
    benchmark::DoNotOptimize(signature);
  }
}

const std::vector<std::int64_t> kKinds = {kCommandMessage, kContributionMessage, kMissionMessage};

BENCHMARK(Close)->ArgNames({"kind", "key"})->ArgsProduct({kKinds, {0, 1}});
BENCHMARK(Open)->ArgNames({"kind", "key"})->ArgsProduct({kKinds, {0, 1}});
BENCHMARK(Refuse)->ArgName("kind")->ArgsProduct({kKinds});
BENCHMARK(KeyedHashAlone)->ArgName("kind")->ArgsProduct({kKinds});
BENCHMARK(SignatureAlone)->ArgName("checks")->Arg(0)->Arg(1);

}  // namespace
}  // namespace ergocast::bench

BENCHMARK_MAIN();
