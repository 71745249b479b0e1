// SPDX-License-Identifier: BSD-3-Clause
// OpenSSL between two buffers in memory: this file moves their bytes from and to the socket. So one
// call handles only the bytes of one recv(). (With the socket itself, OpenSSL would read for as
// long as a client sends messages without content.)
#include "cli/watch/tls_server.h"

#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/ssl.h>
#include <openssl/x509.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <new>
#include <utility>

#include "runtime/process/key_file.h"
#include "text/input_file.h"

namespace ergocast::cli {
namespace {

using Over = ByteStream::Over;

/// Limit (Page): length of the files of --tls-cert and --tls-key [bytes]. Beyond it: the command
/// refuses them.
constexpr std::size_t kLongestPem = 256 << 10;
/// Bytes of the client that one call handles.
constexpr std::size_t kPortion = 4096;
/// The most that one record of TLS holds.
constexpr std::size_t kRecord = SSL3_RT_MAX_PLAIN_LENGTH;

/// For a browser that was told http:// in place of https://.
constexpr const char* kPlainAnswer =
    "HTTP/1.1 400 Bad Request\r\nContent-Type: text/plain; charset=utf-8\r\n"
    "Connection: close\r\nContent-Length: 42\r\n\r\n"
    "this page is encrypted: open it by https:\n";

template <auto kFree>
struct Free {
  template <class T>
  void operator()(T* one) const {
    kFree(one);
  }
};
using Bio = std::unique_ptr<BIO, Free<BIO_free>>;
using Certificate = std::unique_ptr<X509, Free<X509_free>>;
using Key = std::unique_ptr<EVP_PKEY, Free<EVP_PKEY_free>>;
using Context = std::unique_ptr<SSL_CTX, Free<SSL_CTX_free>>;
using Session = std::unique_ptr<SSL, Free<SSL_free>>;

Bio reader_of(const std::string& text) {
  return Bio(BIO_new_mem_buf(text.data(), static_cast<int>(text.size())));
}

/// OpenSSL's words for its last error.
std::string reason() {
  const char* text = ERR_reason_error_string(ERR_peek_last_error());
  return text != nullptr ? text : "no reason given";
}

class TlsStream final : public ByteStream {
 public:
  TlsStream(Socket socket, SSL_CTX* context)
      : ByteStream(std::move(socket)), session_(SSL_new(context)) {
    in_ = BIO_new(BIO_s_mem());
    out_ = BIO_new(BIO_s_mem());
    if (!session_ || in_ == nullptr || out_ == nullptr) throw std::bad_alloc();
    SSL_set_bio(session_.get(), in_, out_);  // which owns them from now on
    SSL_set_accept_state(session_.get());
  }

  Result<std::size_t, Over> read(std::span<char> to) override {
    if (const auto sent = flush(); !sent || !*sent) return nothing_read(sent);
    const auto known = decrypt(to);
    if (!known || *known > 0) return known;
    std::array<char, kPortion> portion;
    const auto received = receive_some(fd(), portion);
    if (!received || *received == 0) return received;
    BIO_write(in_, portion.data(), static_cast<int>(*received));
    const auto count = decrypt(to);
    const auto sent = flush();  // what a handshake answers, or the reason of an error
    return !count || *count > 0 || sent ? count : failure(sent.error());
  }

  /// One record at a time: it counts when the kernel has all of it.
  Result<std::size_t, Over> write(std::string_view from) override {
    if (in_record_ == 0) {
      ERR_clear_error();
      const int size = static_cast<int>(std::min(from.size(), kRecord));
      const int count = SSL_write(session_.get(), from.data(), size);
      if (count <= 0) return nothing_written(count);
      in_record_ = static_cast<std::size_t>(count);
      keep_output();
    }
    const auto sent = flush();
    if (!sent) return failure(sent.error());
    return *sent ? std::exchange(in_record_, 0) : 0;
  }

  void finish() override {
    ERR_clear_error();
    SSL_shutdown(session_.get());
    keep_output();
    finishing_ = true;
    (void)flush();
  }

  bool owes() const override { return sent_ < output_.size(); }

 private:
  static Result<std::size_t, Over> nothing_read(const Result<bool, Over>& sent) {
    if (!sent) return failure(sent.error());
    return 0;
  }

  Result<std::size_t, Over> nothing_written(int result) {
    if (SSL_get_error(session_.get(), result) == SSL_ERROR_WANT_READ) return 0;
    return failure(Over::kBroken);
  }

  /// What the client has sent so far, as far as `to` holds it.
  Result<std::size_t, Over> decrypt(std::span<char> to) {
    ERR_clear_error();
    const int count = SSL_read(session_.get(), to.data(), static_cast<int>(to.size()));
    keep_output();
    if (count > 0) return static_cast<std::size_t>(count);
    switch (SSL_get_error(session_.get(), count)) {
      case SSL_ERROR_WANT_READ:
        return 0;
      case SSL_ERROR_ZERO_RETURN:
        return failure(Over::kClosed);
      default:
        if (ERR_GET_REASON(ERR_peek_error()) == SSL_R_HTTP_REQUEST) output_ += kPlainAnswer;
        return failure(Over::kBroken);
    }
  }

  /// Moves OpenSSL's output here.
  void keep_output() {
    const std::size_t known = output_.size(), more = BIO_ctrl_pending(out_);
    if (more == 0) return;
    output_.resize(known + more);
    BIO_read(out_, output_.data() + known, static_cast<int>(more));
  }

  /// Whether the kernel has everything.
  Result<bool, Over> flush() {
    while (owes()) {
      const auto count = send_some(fd(), std::string_view(output_).substr(sent_));
      if (!count) return failure(count.error());
      if (*count == 0) return false;
      sent_ += *count;
    }
    output_.clear();
    sent_ = 0;
    if (std::exchange(finishing_, false)) shutdown(fd(), SHUT_WR);
    return true;
  }

  Session session_;
  BIO* in_ = nullptr;
  BIO* out_ = nullptr;
  std::string output_;  // encrypted
  std::size_t sent_ = 0, in_record_ = 0;
  bool finishing_ = false;
};

std::string remedy() {
  return "; docs/monitoring.md shows how to make a certificate and its key with openssl";
}

Result<Key> parse_key(const std::string& text, const std::string& name) {
  // Without this, OpenSSL would ask for a password on the terminal.
  bool encrypted = false;
  const auto no_password = [](char*, int, int, void* asked) {
    *static_cast<bool*>(asked) = true;
    return -1;
  };
  Key key(PEM_read_bio_PrivateKey(reader_of(text).get(), nullptr, no_password, &encrypted));
  if (encrypted)
    return failure(name + ": is encrypted; `openssl pkey -in " + name +
                   " -out FILE` writes a copy without a password");
  if (!key) return failure(name + ": no private key in PEM format" + remedy());
  return key;
}

Context new_context() {
  Context context(SSL_CTX_new(TLS_server_method()));
  SSL_CTX* const c = context.get();
  SSL_CTX_set_min_proto_version(c, TLS1_2_VERSION);
  SSL_CTX_set_cipher_list(c, "ECDHE+AESGCM:ECDHE+CHACHA20");  // of TLS 1.2
  SSL_CTX_set_options(c, SSL_OP_NO_RENEGOTIATION | SSL_OP_NO_TICKET | SSL_OP_NO_COMPRESSION);
  SSL_CTX_set_num_tickets(c, 0);
  SSL_CTX_set_session_cache_mode(c, SSL_SESS_CACHE_OFF);
  SSL_CTX_set_mode(c, SSL_MODE_RELEASE_BUFFERS | SSL_MODE_ACCEPT_MOVING_WRITE_BUFFER);
  return context;
}

/// Gives the context the certificate and those that lead to its root; false if there is none, or
/// OpenSSL does not accept it.
std::optional<std::string> use_certificates(SSL_CTX* context, const std::string& text,
                                            const std::string& name) {
  const Bio bio = reader_of(text);
  const Certificate first(PEM_read_bio_X509(bio.get(), nullptr, nullptr, nullptr));
  if (!first) return name + ": no certificate in PEM format" + remedy();
  ERR_clear_error();
  if (SSL_CTX_use_certificate(context, first.get()) != 1)
    return name + ": OpenSSL does not accept it (" + reason() + ")" + remedy();
  while (Certificate next{PEM_read_bio_X509(bio.get(), nullptr, nullptr, nullptr)}) {
    SSL_CTX_add0_chain_cert(context, next.release());
  }
  return std::nullopt;
}

std::string text_of(const ASN1_TIME* time) {
  const Bio bio(BIO_new(BIO_s_mem()));
  ASN1_TIME_print(bio.get(), time);
  char* text = nullptr;
  const long size = BIO_get_mem_data(bio.get(), &text);
  return {text, static_cast<std::size_t>(size)};
}

class Server final : public TlsServer {
 public:
  Server(Context context, std::string name, std::string certificate, std::string key)
      : context_(std::move(context)),
        name_(std::move(name)),
        certificate_(std::move(certificate)),
        key_(std::move(key)) {}

  std::optional<std::string> why_not_valid(
      std::chrono::system_clock::time_point at) const override {
    std::time_t time = std::chrono::system_clock::to_time_t(at);
    const X509* one = SSL_CTX_get0_certificate(context_.get());
    if (X509_cmp_time(X509_get0_notAfter(one), &time) < 0) {
      return name_ + ": expired on " + text_of(X509_get0_notAfter(one)) +
             "; renew it, or make a new one" + remedy();
    }
    if (X509_cmp_time(X509_get0_notBefore(one), &time) > 0) {
      return name_ + ": not valid before " + text_of(X509_get0_notBefore(one)) +
             "; is the clock of this host right?";
    }
    return std::nullopt;
  }
  std::unique_ptr<ByteStream> open(Socket socket) const override {
    return std::make_unique<TlsStream>(std::move(socket), context_.get());
  }
  const std::string& certificate() const override { return certificate_; }
  const std::string& key() const override { return key_; }

 private:
  Context context_;
  std::string name_, certificate_, key_;
};

}  // namespace

Result<std::shared_ptr<const TlsServer>> TlsServer::read(const TlsFiles& files) {
  const std::string name = files.certificate.string(), key_name = files.key.string();
  auto certificate = read_whole(files.certificate, kLongestPem);
  if (!certificate) return failure(certificate.error().sentence(files.certificate));
  auto text = read_private_file(files.key, kLongestPem,
                                "; name the key that was made with the certificate");
  if (!text) return failure(std::move(text).error());

  Context context = new_context();
  if (auto problem = use_certificates(context.get(), *certificate, name)) return failure(*problem);
  const auto key = parse_key(*text, key_name);
  if (!key) return failure(key.error());
  if (X509_check_private_key(SSL_CTX_get0_certificate(context.get()), key->get()) != 1) {
    return failure(key_name + ": not the key of the certificate in " + name +
                   "; name the two files that were made together");
  }
  ERR_clear_error();
  if (SSL_CTX_use_PrivateKey(context.get(), key->get()) != 1) {
    return failure(key_name + ": OpenSSL does not accept it (" + reason() + ")" + remedy());
  }
  return std::make_shared<const Server>(std::move(context), name, *std::move(certificate),
                                        *std::move(text));
}

}  // namespace ergocast::cli
