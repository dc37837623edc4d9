// A web server on this machine that counts what it is asked for: what nobody may fetch stays at 0.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <stdexcept>
#include <string>
#include <thread>

namespace vfplan::test {

// Answers HEAD and GET, also of a part, with the pages it was given by path ("/site.geojson"), and
// 404 to all else. A port of its own, on the loopback interface only.
class HttpServer {
public:
    explicit HttpServer(std::map<std::string, std::string> pages)
        : pages_(std::move(pages)), listening_(socket(AF_INET, SOCK_STREAM, 0)) {
        sockaddr_in at{};
        at.sin_family = AF_INET;
        at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t size = sizeof at;
        auto* address = reinterpret_cast<sockaddr*>(&at);
        if (bind(listening_, address, size) != 0 || listen(listening_, 16) != 0 ||
            getsockname(listening_, address, &size) != 0) {
            throw std::runtime_error("no port for a server");
        }
        url_ = "http://127.0.0.1:" + std::to_string(ntohs(at.sin_port));
        thread_ = std::thread([this] { serve(); });
    }
    ~HttpServer() {
        ending_ = true;
        shutdown(listening_, SHUT_RDWR);
        thread_.join();
        close(listening_);
    }
    HttpServer(const HttpServer&) = delete;
    HttpServer& operator=(const HttpServer&) = delete;

    const std::string& url() const { return url_; }
    int requests() const { return requests_; }

private:
    void serve() {
        for (;;) {
            const int to = accept(listening_, nullptr, nullptr);
            if (to < 0 || ending_) return;
            ++requests_;  // a connection is one too many already
            std::string asked;
            char part[4096];
            while (asked.find("\r\n\r\n") == std::string::npos) {
                const ssize_t n = recv(to, part, sizeof part, 0);
                if (n <= 0) break;
                asked.append(part, static_cast<std::size_t>(n));
            }
            const std::string said = answer(asked);
            for (std::size_t done = 0; done < said.size();) {
                const ssize_t n = send(to, said.data() + done, said.size() - done, MSG_NOSIGNAL);
                if (n <= 0) break;
                done += static_cast<std::size_t>(n);
            }
            close(to);
        }
    }

    std::string answer(const std::string& asked) const {
        const auto from = std::min(asked.find(' '), asked.size() - 1) + 1;
        const auto page = pages_.find(asked.substr(from, asked.find_first_of(" ?", from) - from));
        if (page == pages_.end()) {
            return "HTTP/1.1 404 Not Found\r\nContent-Length: 0\r\nConnection: close\r\n\r\n";
        }
        std::string body = page->second;
        std::string head = "HTTP/1.1 200 OK\r\n";
        if (const auto range = asked.find("Range: bytes="); range != std::string::npos) {
            const std::string words = asked.substr(range + 13);
            const std::size_t first = std::stoul(words);
            const std::size_t last =
                std::min(std::stoul(words.substr(words.find('-') + 1)), body.size() - 1);
            head = "HTTP/1.1 206 Partial Content\r\nContent-Range: bytes " + std::to_string(first) +
                   "-" + std::to_string(last) + "/" + std::to_string(body.size()) + "\r\n";
            body = body.substr(first, last - first + 1);
        }
        head += "Accept-Ranges: bytes\r\nConnection: close\r\nContent-Length: " +
                std::to_string(body.size()) + "\r\n\r\n";
        return asked.rfind("HEAD", 0) == 0 ? head : head + body;
    }

    std::map<std::string, std::string> pages_;
    int listening_;
    std::string url_;
    std::atomic<int> requests_ = 0;
    std::atomic<bool> ending_ = false;
    std::thread thread_;
};

}  // namespace vfplan::test
