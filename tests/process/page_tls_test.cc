// SPDX-License-Identifier: BSD-3-Clause
// Pages over TLS: users, operators of another host, and clients that try to keep them out.
#include <sys/stat.h>

#include <atomic>
#include <cstdlib>
#include <memory>
#include <thread>

#include "tests/process/support/mission.h"
#include "tests/support/http.h"
#include "tests/support/tls.h"

namespace ergocast::test {
namespace {

constexpr int kTlsPort = 8765;
const std::string kTlsHost = "Host: 127.0.0.1:8765";

class EncryptedPage : public RunningMission {
 protected:
  std::vector<std::string> with_tls(std::vector<std::string> more = {}) {
    const auto [certificate, key] = make_certificate(folder_, "page");
    more.insert(more.end(), {"--tls-cert", certificate, "--tls-key", key});
    return more;
  }
  /// What follows `begin` in what the command printed, up to the end of a token.
  static std::string token_after(const std::string& text, const std::string& begin) {
    const auto at = text.find(begin);
    EXPECT_NE(at, text.npos) << text;
    return at == text.npos ? "" : text.substr(at + begin.size(), 32);
  }
  bool prints(const std::string& part) {
    return eventually([&] { return printed(part); });
  }
  /// The page of a mission that has ended.
  void end(Child& mission) {
    mission.send(SIGINT);
    EXPECT_TRUE(prints("until Ctrl-C")) << printed();
    mission.send(SIGINT);
    EXPECT_EQ(wait_for(mission), 0) << printed();
  }
};

bool shows_the_mission(HttpsConnection& stream) {
  const auto comes = [](const std::string& text) {
    return text.find("event: mission") != text.npos;
  };
  stream.send("GET /events HTTP/1.1\r\n" + kTlsHost + "\r\n\r\n");
  return comes(stream.read_until(comes));
}

TEST_F(EncryptedPage, IsServedByHttpsOnlyAlsoAfterItsProcessWasKilled) {
  const std::string key = folder_ / "team";
  ASSERT_EQ(ergocast({"keygen", key}), 0) << output();
  Child mission = launch_endless(scenario("pace: REALTIME"),
                                 with_tls({"--watch", "--key-file", key + ".coordinator.key"}));
  EXPECT_TRUE(printed("https://127.0.0.1:8765/")) << printed();
  for (const bool again : {false, true}) {
    const HttpAnswer page =
        https(kTlsPort, "GET", "/", {kTlsHost, "Origin: https://127.0.0.1:8765"});
    EXPECT_EQ(page.status, 200);
    EXPECT_NE(page.body.find("</html>"), std::string::npos);
    EXPECT_FALSE(page.contains("Strict-Transport-Security"));
    EXPECT_EQ(https(kTlsPort, "GET", "/", {kTlsHost, "Origin: http://127.0.0.1:8765"}).status, 403);
    HttpsConnection events(kTlsPort);
    EXPECT_TRUE(shows_the_mission(events));
    if (!again) kill_next({"ergocast run-page"});
  }
  end(mission);
  EXPECT_NE(https(kTlsPort, "GET", "/", {kTlsHost}).status, 200);  // it has ended with the run
}

TEST_F(EncryptedPage, PlainHttpAndOldVersionsGetNothing) {
  Child mission = launch_endless(scenario("pace: REALTIME"), with_tls({"--watch"}));
  const HttpAnswer plain = get(kTlsPort, "/");
  EXPECT_EQ(plain.status, 400);
  EXPECT_EQ(plain.body, "this page is encrypted: open it by https:\n");
  HttpConnection noise(kTlsPort);
  noise.send(std::string(100'000, '\0'));
  EXPECT_EQ(noise.read_until([](const std::string&) { return false; }).find("HTTP"),
            std::string::npos);
  EXPECT_FALSE(HttpsConnection(kTlsPort, "127.0.0.1", 0x0302).open());  // TLS 1.1
  EXPECT_TRUE(HttpsConnection(kTlsPort, "127.0.0.1", 0x0303).open());
  EXPECT_EQ(https(kTlsPort, "GET", "/", {kTlsHost}).status, 200);
  end(mission);
}

TEST_F(EncryptedPage, AnOperatorOfAnotherHostIsObeyed) {
  Child mission = launch_endless(scenario("pace: REALTIME realtime_factor: 10"),
                                 with_tls({"--watch", "--control", "--listen", "127.0.0.2"}));
  const std::string text = printed(), own = "https://127.0.0.2:8765";
  const std::string token = token_after(text, own + "/?token="),
                    right = token_after(text, "#control=");
  const auto ask = [&](const std::string& method, const std::string& target,
                       std::vector<std::string> headers) {
    headers.push_back("Host: 127.0.0.2:8765");
    return https(kTlsPort, method, target, headers, "127.0.0.2");
  };
  const HttpAnswer let_in = ask("GET", "/?token=" + token, {});
  EXPECT_EQ(let_in.status, 303);
  EXPECT_TRUE(let_in.contains("Set-Cookie: ergocast-8765=" + token +
                              "; HttpOnly; SameSite=Strict; Path=/; Secure"))
      << let_in.head;
  const std::string cookie = "Cookie: ergocast-8765=" + token;
  const auto order = [&](const std::string& origin, const std::string& known,
                         const std::string& cookies) {
    const nlohmann::json request{
        {"operator", 7}, {"name", "anna"}, {"number", 1}, {"tick", 0}, {"act", "stop-now"}};
    return ask("POST", "/control",
               {"Origin: " + origin, "X-Ergocast-Token: " + known,
                "X-Ergocast-Request: " + request.dump(), cookies})
        .status;
  };
  EXPECT_EQ(order("http://127.0.0.2:8765", right, cookie), 403);
  EXPECT_EQ(order(own, token, cookie), 403);
  EXPECT_EQ(order(own, right, "X: none"), 403);
  EXPECT_TRUE(moves_on());
  EXPECT_EQ(order(own, right, cookie), 202);
  EXPECT_TRUE(prints("control: stop now of anna")) << printed();
  EXPECT_TRUE(prints("until Ctrl-C")) << printed();
  mission.send(SIGINT);
  EXPECT_EQ(wait_for(mission), 0) << printed();
}

TEST_F(EncryptedPage, HalfOpenHandshakesDoNotKeepItFromTheUser) {
  Child mission = launch_endless(scenario("pace: REALTIME"), with_tls({"--watch"}));
  ASSERT_EQ(https(kTlsPort, "GET", "/", {kTlsHost}).status, 200);
  std::vector<std::unique_ptr<HttpConnection>> half;
  for (int i = 0; i < 191; ++i) {
    half.push_back(std::make_unique<HttpConnection>(kTlsPort));
    half.back()->send(std::string("\x16\x03\x01\x10\x00\x01\x00\x0f\xfc\x03\x03", 11));
  }
  std::atomic<bool> done = false;
  std::thread trickle([&] {  // each of them continues
    for (; !done; std::this_thread::sleep_for(std::chrono::milliseconds(100))) {
      for (const auto& one : half) one->send("x");
    }
  });
  EXPECT_EQ(https(kTlsPort, "GET", "/", {kTlsHost}).status, 200);
  HttpsConnection users(kTlsPort);
  EXPECT_TRUE(shows_the_mission(users));
  done = true;
  trickle.join();
  end(mission);
}

TEST_F(EncryptedPage, ABadCertificateOrKeyIsNamedWithItsRemedy) {
  const auto [pem, key] = make_certificate(folder_, "page");
  const auto [other_pem, other_key] = make_certificate(folder_, "other");
  const auto [old_pem, old_key] = make_certificate(folder_, "old", {-7200, -3600});
  const auto [early_pem, early_key] = make_certificate(folder_, "early", {3600, 7200});
  const auto text = folder_ / "text";
  std::ofstream(text) << "no certificate\n";
  chmod(text.c_str(), 0600);
  const auto open_key = folder_ / "open.key";
  std::filesystem::copy_file(key, open_key);
  chmod(open_key.c_str(), 0640);
  const auto locked = folder_ / "locked.key";
  ASSERT_EQ(std::system(("openssl pkey -in " + key.string() + " -aes256 -passout pass:x -out " +
                         locked.string())
                            .c_str()),
            0);
  chmod(locked.c_str(), 0600);
  struct Case {
    std::filesystem::path certificate, key;
    std::string problem;
  };
  for (const auto& [certificate, own, problem] :
       {Case{folder_ / "none.pem", key, "none.pem: "},
        Case{text, key, "text: no certificate in PEM"},
        Case{pem, folder_ / "none.key", "none.key: No such file"},
        Case{pem, text, "text: no private key in PEM"}, Case{pem, pem, "page.pem: "},
        Case{pem, open_key, "open.key: others than its owner may use this key; chmod 600"},
        Case{pem, locked, "locked.key: is encrypted; `openssl pkey -in "},
        Case{pem, other_key, "other.key: not the key of the certificate in "},
        Case{old_pem, old_key, "old.pem: expired on "},
        Case{early_pem, early_key, "early.pem: not valid before "}}) {
    for (const std::vector<std::string>& command :
         {std::vector<std::string>{"run", scenario_file("quadrimodal_corners"), "--out", out(),
                                   "--watch"},
          std::vector<std::string>{"watch", out()}}) {
      auto arguments = command;
      arguments.insert(arguments.end(), {"--tls-cert", certificate, "--tls-key", own});
      EXPECT_EQ(ergocast(arguments), 2) << problem;
      const std::string said = output();
      EXPECT_NE(said.find(problem), std::string::npos) << said;
      EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
    }
  }
  EXPECT_EQ(ergocast({"watch", out(), "--tls-cert", pem}), 2);
  EXPECT_NE(output().find("--tls-cert and --tls-key belong together"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(out()));
}

TEST_F(EncryptedPage, ARecordIsServedWithACertificateOfTheDocumentedCommand) {
  ASSERT_EQ(ergocast({"simulate", scenario_file("quadrimodal_corners"), "--duration", "5", "--out",
                      out()}),
            0);
  const std::string document =
      text_of(std::filesystem::path(ERGOCAST_SOURCE_DIR) / "docs" / "monitoring.md");
  const auto begin = document.find("openssl req -x509");
  ASSERT_NE(begin, document.npos);
  const std::string command = document.substr(begin, document.find("\n\n", begin) - begin);
  ASSERT_EQ(std::system(("cd " + folder_.string() + " && " + command + " 2>/dev/null").c_str()), 0)
      << command;
  Child watch = start("ergocast", {"watch", out(), "--tls-cert", folder_ / "page.pem", "--tls-key",
                                   folder_ / "page.key"});
  ASSERT_TRUE(eventually([&] { return text_of(log_).find("Ctrl-C") != std::string::npos; }))
      << text_of(log_);
  EXPECT_NE(text_of(log_).find("https://127.0.0.1:8765/"), std::string::npos) << text_of(log_);
  HttpsConnection user(kTlsPort);
  user.send("GET / HTTP/1.1\r\n" + kTlsHost + "\r\n\r\n");
  const std::string& all = user.read_until([](const std::string&) { return false; });
  EXPECT_NE(all.find("quadrimodal_corners"), std::string::npos);
  EXPECT_TRUE(user.ended_in_order());
  watch.send(SIGINT);
  EXPECT_EQ(wait_for(watch), 0) << text_of(log_);
}

}  // namespace
}  // namespace ergocast::test
