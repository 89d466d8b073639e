#include "transport.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <random>
#include <stdexcept>
#include <utility>

namespace streaming {
namespace {

constexpr size_t kChannels = 2; // 0: reliable messages; 1: all others
constexpr int kSocketBytes = 4 << 20;

/// The first thing that anybody needs.
ENetAddress addressOf(const std::string& name, uint16_t port) {
  if (enet_initialize() != 0) throw std::runtime_error("ENet does not begin"); // again and again is allowed
  ENetAddress address{};
  address.port = port;
  if (enet_address_set_host(&address, name.c_str()) != 0) throw std::runtime_error("unknown address " + name);
  return address;
}

void configure(ENetPeer* peer) {
  // Frames that are late are dropped here by what is newer, not by ENet's guess at what the network can carry.
  enet_peer_throttle_configure(peer, ENET_PEER_PACKET_THROTTLE_INTERVAL, ENET_PEER_PACKET_THROTTLE_SCALE, 0);
}

} // namespace

Endpoint::Endpoint(ENetHost* host) : host_(host) {
  if (!host) throw std::runtime_error("no socket for this address and port");
  host->checksum = enet_crc32;
  enet_socket_set_option(host->socket, ENET_SOCKOPT_RCVBUF, kSocketBytes);
  enet_socket_set_option(host->socket, ENET_SOCKOPT_SNDBUF, kSocketBytes);
}

Endpoint Endpoint::listenAt(const std::string& name, uint16_t port) {
  const ENetAddress address = addressOf(name, port);
  Endpoint endpoint(enet_host_create(&address, 1, kChannels, 0, 0));
  if (enet_socket_get_address(endpoint.host_->socket, &endpoint.host_->address) != 0)
    throw std::runtime_error("no address of the socket");
  return endpoint;
}

Endpoint Endpoint::connectTo(const std::string& name, uint16_t port, double seconds) {
  const ENetAddress address = addressOf(name, port);
  Endpoint endpoint(enet_host_create(nullptr, 1, kChannels, 0, 0));
  ENetPeer* peer = enet_host_connect(endpoint.host_.get(), &address, kChannels, 0);
  // ENet sends again what was lost only when it is called.
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  for (ENetEvent event{}; peer && std::chrono::steady_clock::now() < end;) {
    if (enet_host_service(endpoint.host_.get(), &event, 10) <= 0) continue;
    if (event.type != ENET_EVENT_TYPE_CONNECT) break;
    configure(endpoint.peer_ = peer);
    return endpoint;
  }
  throw std::runtime_error("no answer from " + name + ":" + std::to_string(port));
}

void Endpoint::send(const Bytes& message, bool reliable) {
  if (!peer_) return;
  ENetPacket* packet = enet_packet_create(message.data(), message.size(),
                                          reliable ? ENET_PACKET_FLAG_RELIABLE : ENET_PACKET_FLAG_UNSEQUENCED);
  if (!packet) throw std::bad_alloc();
  if (enet_peer_send(peer_, reliable ? 0 : 1, packet) != 0) enet_packet_destroy(packet);
}

void Endpoint::take(ENetEvent& event, const std::function<void(ByteSpan)>& onMessage) {
  if (event.type == ENET_EVENT_TYPE_CONNECT) configure(peer_ = event.peer);
  if (event.type == ENET_EVENT_TYPE_DISCONNECT) peer_ = nullptr;
  if (event.type != ENET_EVENT_TYPE_RECEIVE) return;
  const std::unique_ptr<ENetPacket, decltype(&enet_packet_destroy)> packet(event.packet, enet_packet_destroy);
  onMessage({packet->data, packet->dataLength});
}

void Endpoint::poll(uint32_t milliseconds, const std::function<void(ByteSpan)>& onMessage) {
  ENetEvent event{};
  int count = enet_host_service(host_.get(), &event, milliseconds);
  for (; count > 0; count = enet_host_service(host_.get(), &event, 0)) take(event, onMessage);
  if (count < 0) throw std::runtime_error("the socket failed");
  receivedBytes();
  sentBytes();
}

void Endpoint::disconnect() {
  if (!peer_) return;
  enet_peer_disconnect_later(peer_, 0);
  for (int i = 0; i < 20 && peer_; ++i) poll(50, [](ByteSpan) {});
  if (peer_) enet_peer_reset(peer_);
  peer_ = nullptr;
}

uint64_t Endpoint::receivedBytes() { // ENet counts in 32 bits
  received_ += std::exchange(host_->totalReceivedData, 0u);
  return received_;
}
uint64_t Endpoint::sentBytes() {
  sent_ += std::exchange(host_->totalSentData, 0u);
  return sent_;
}

Relay::Relay(const std::string& name, uint16_t port, const RelayOptions& options)
    : options_(options), server_(addressOf(name, port)) {
  for (ENetSocket& socket : sockets_) {
    socket = enet_socket_create(ENET_SOCKET_TYPE_DATAGRAM);
    ENetAddress any = addressOf(&socket == sockets_ ? "127.0.0.1" : "0.0.0.0", 0);
    if (socket == ENET_SOCKET_NULL || enet_socket_bind(socket, &any) != 0 || enet_socket_get_address(socket, &any) != 0)
      throw std::runtime_error("no socket for the relay");
    enet_socket_set_option(socket, ENET_SOCKOPT_NONBLOCK, 1);
    enet_socket_set_option(socket, ENET_SOCKOPT_RCVBUF, kSocketBytes);
    enet_socket_set_option(socket, ENET_SOCKOPT_SNDBUF, kSocketBytes);
    if (&socket == sockets_) port_ = any.port;
  }
  thread_ = std::thread([this] { run(); });
}

Relay::~Relay() {
  ends_ = true;
  thread_.join();
  for (const ENetSocket socket : sockets_) enet_socket_destroy(socket);
}

void Relay::run() {
  using Clock = std::chrono::steady_clock;
  struct Datagram {
    int to; // socket that it leaves through
    Bytes bytes;
  };
  constexpr size_t kMostHeld = 16u << 20;
  std::multimap<Clock::time_point, Datagram> held;
  size_t heldBytes = 0;
  ENetAddress client{};
  std::mt19937_64 random[2] = {std::mt19937_64(options_.seed), std::mt19937_64(options_.seed + 1)};
  const auto chance = [](std::mt19937_64& numbers) { return static_cast<double>(numbers() >> 11) * 0x1p-53; };
  Bytes room(1 << 16);
  while (!ends_) {
    ENetSocketSet set;
    ENET_SOCKETSET_EMPTY(set);
    for (const ENetSocket socket : sockets_) ENET_SOCKETSET_ADD(set, socket);
    enet_socketset_select(std::max(sockets_[0], sockets_[1]), &set, nullptr, 1);
    for (int from = 0; from < 2; ++from)
      for (;;) {
        ENetAddress sender{};
        ENetBuffer buffer{};
        buffer.data = room.data();
        buffer.dataLength = room.size();
        const int bytes = enet_socket_receive(sockets_[from], &sender, &buffer, 1);
        if (bytes <= 0) break;
        if (from == 0) client = sender;
        ++datagrams_;
        const bool loses = chance(random[from]) * 100 < options_.loss;
        const double milliseconds = options_.latency * 0.5 + options_.jitter * chance(random[from]);
        if (loses || heldBytes + static_cast<size_t>(bytes) > kMostHeld) {
          ++lost_;
          continue;
        }
        heldBytes += static_cast<size_t>(bytes);
        held.emplace(Clock::now() + std::chrono::microseconds(static_cast<int64_t>(milliseconds * 1000)),
                     Datagram{1 - from, Bytes(room.begin(), room.begin() + bytes)});
      }
    while (!held.empty() && held.begin()->first <= Clock::now()) {
      Datagram& datagram = held.begin()->second;
      ENetBuffer buffer{};
      buffer.data = datagram.bytes.data();
      buffer.dataLength = datagram.bytes.size();
      enet_socket_send(sockets_[datagram.to], datagram.to == 0 ? &client : &server_, &buffer, 1);
      heldBytes -= datagram.bytes.size();
      held.erase(held.begin());
    }
  }
}

} // namespace streaming
