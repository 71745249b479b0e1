// SPDX-License-Identifier: BSD-3-Clause
// OpenSSL on a blocking socket.
#include "tests/support/tls.h"

#include <arpa/inet.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/ssl.h>
#include <openssl/x509.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

namespace ergocast::test {

std::pair<std::filesystem::path, std::filesystem::path> make_certificate(
    const std::filesystem::path& folder, const std::string& name, std::pair<long, long> valid_s) {
  EVP_PKEY* key = EVP_EC_gen("P-256");
  X509* one = X509_new();
  ASN1_INTEGER_set(X509_get_serialNumber(one), 1);
  X509_gmtime_adj(X509_getm_notBefore(one), valid_s.first);
  X509_gmtime_adj(X509_getm_notAfter(one), valid_s.second);
  X509_set_pubkey(one, key);
  X509_NAME* subject = X509_get_subject_name(one);
  X509_NAME_add_entry_by_txt(subject, "CN", MBSTRING_ASC,
                             reinterpret_cast<const unsigned char*>("localhost"), -1, -1, 0);
  X509_set_issuer_name(one, subject);
  X509_sign(one, key, EVP_sha256());
  const auto pem = folder / (name + ".pem"), key_file = folder / (name + ".key");
  std::FILE* file = std::fopen(pem.c_str(), "w");
  PEM_write_X509(file, one);
  std::fclose(file);
  file = std::fopen(key_file.c_str(), "w");
  chmod(key_file.c_str(), 0600);
  PEM_write_PrivateKey(file, key, nullptr, nullptr, 0, nullptr, nullptr);
  std::fclose(file);
  X509_free(one);
  EVP_PKEY_free(key);
  return {pem, key_file};
}

struct HttpsConnection::Parts {
  SSL_CTX* context = SSL_CTX_new(TLS_client_method());
  SSL* session = nullptr;
  int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  bool open = false;
  std::string received;
};

HttpsConnection::HttpsConnection(int port, const std::string& address, int most)
    : parts_(std::make_unique<Parts>()) {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<std::uint16_t>(port));
  inet_pton(AF_INET, address.c_str(), &to.sin_addr);
  const timeval patience{300, 0};
  setsockopt(parts_->socket, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  if (connect(parts_->socket, reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0) return;
  if (most != 0) {
    SSL_CTX_set_security_level(parts_->context, 0);  // otherwise OpenSSL offers no old version
    SSL_CTX_set_min_proto_version(parts_->context, 0);
    SSL_CTX_set_max_proto_version(parts_->context, most);
  }
  parts_->session = SSL_new(parts_->context);
  SSL_set_fd(parts_->session, parts_->socket);
  parts_->open = SSL_connect(parts_->session) == 1;
}

HttpsConnection::~HttpsConnection() {
  SSL_free(parts_->session);
  SSL_CTX_free(parts_->context);
  close(parts_->socket);
}

bool HttpsConnection::open() const { return parts_->open; }

void HttpsConnection::send(const std::string& bytes) {
  if (open()) SSL_write(parts_->session, bytes.data(), static_cast<int>(bytes.size()));
}

const std::string& HttpsConnection::read_until(
    const std::function<bool(const std::string&)>& enough) {
  char buffer[16384];
  while (open() && !enough(parts_->received)) {
    const int count = SSL_read(parts_->session, buffer, sizeof buffer);
    if (count <= 0) break;
    parts_->received.append(buffer, static_cast<std::size_t>(count));
  }
  return parts_->received;
}

bool HttpsConnection::ended_in_order() const {
  return open() && (SSL_get_shutdown(parts_->session) & SSL_RECEIVED_SHUTDOWN) != 0;
}

HttpAnswer https(int port, const std::string& method, const std::string& target,
                 const std::vector<std::string>& headers, const std::string& address) {
  HttpsConnection connection(port, address);
  std::string request = method + ' ' + target + " HTTP/1.1\r\nConnection: close\r\n";
  for (const std::string& header : headers) request += header + "\r\n";
  connection.send(request + "\r\n");
  // An answer ends with its connection.
  const std::string& text = connection.read_until([](const std::string&) { return false; });
  const auto head = text.find("\r\n\r\n");
  if (head == text.npos || !text.starts_with("HTTP/1.1 ")) return {};
  return {std::atoi(text.c_str() + 9), text.substr(0, head), text.substr(head + 4)};
}

}  // namespace ergocast::test
