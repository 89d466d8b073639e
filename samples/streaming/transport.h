// Datagrams through ENet, and a relay that makes a bad network of a good one.
#pragma once
#include "bytes.h"

#include <enet/enet.h>

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <thread>

namespace streaming {

/// One end of one connection. Messages are reliable and in order, or else as the network has them: late, doubly or not
/// at all.
class Endpoint {
public:
  /// Waits for one peer. port 0: any free one. Throws std::runtime_error where the address cannot be used.
  static Endpoint listenAt(const std::string& address, uint16_t port);
  /// Throws std::runtime_error where there is no answer for so many seconds.
  static Endpoint connectTo(const std::string& address, uint16_t port, double seconds);
  Endpoint(Endpoint&&) = default;

  uint16_t port() const { return host_->address.port; }
  bool isConnected() const { return peer_ != nullptr; }
  void send(const Bytes& message, bool reliable);
  /// Waits up to so many milliseconds for something to come, and hands all over that has come.
  void poll(uint32_t milliseconds, const std::function<void(ByteSpan)>& onMessage);
  /// Tells the peer, and waits a little for its answer.
  void disconnect();
  uint64_t receivedBytes(); ///< since the connection was made, with ENet's own
  uint64_t sentBytes();

private:
  struct Free {
    void operator()(ENetHost* host) const { enet_host_destroy(host); }
  };
  explicit Endpoint(ENetHost* host);
  void take(ENetEvent& event, const std::function<void(ByteSpan)>& onMessage);
  std::unique_ptr<ENetHost, Free> host_;
  ENetPeer* peer_ = nullptr;
  uint64_t received_ = 0, sent_ = 0;
};

struct RelayOptions {
  double latency = 0; ///< milliseconds that a round trip takes longer, half of it each way
  double jitter = 0;  ///< milliseconds at most that a datagram takes longer still, each way
  double loss = 0;    ///< per cent of datagrams, each way
  uint64_t seed = 1;  ///< which datagrams, by their number
  bool isNeeded() const { return latency > 0 || jitter > 0 || loss > 0; }
};

/// Between a client on this machine and its server, in a thread of its own: everything of ENet's goes through it,
/// acknowledgements too.
class Relay {
public:
  Relay(const std::string& address, uint16_t port, const RelayOptions& options);
  ~Relay();
  Relay(const Relay&) = delete;
  Relay& operator=(const Relay&) = delete;
  uint16_t port() const { return port_; } ///< of 127.0.0.1, for the client
  uint64_t datagrams() const { return datagrams_; }
  uint64_t lost() const { return lost_; }

private:
  void run();
  RelayOptions options_;
  ENetAddress server_{};
  ENetSocket sockets_[2] = {ENET_SOCKET_NULL, ENET_SOCKET_NULL}; // towards the client, towards the server
  uint16_t port_ = 0;
  std::atomic<bool> ends_{false};
  std::atomic<uint64_t> datagrams_{0}, lost_{0};
  std::thread thread_;
};

} // namespace streaming
