"""A client of `octafront serve --mcp` for tests: a line of JSON each way, nothing behind it."""
import json
import queue
import subprocess
import threading
import time


class Client:
    def __init__(self, octafront, *arguments, cwd=None, env=None, protocol="2025-06-18"):
        self.process = subprocess.Popen([octafront, "serve", "--mcp", *map(str, arguments)], stdin=subprocess.PIPE,
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE, cwd=cwd, env=env)
        self.lines, self.notifications, self.number, self.transcript = queue.Queue(), [], 0, []
        threading.Thread(target=self._read, daemon=True).start()
        if protocol:
            self.hello = self.request("initialize", {"protocolVersion": protocol, "capabilities": {},
                                                     "clientInfo": {"name": "test", "version": "1"}})["result"]
            self.notify("notifications/initialized")

    def _read(self):
        for line in self.process.stdout:
            self.lines.put(line)
        self.lines.put(None)

    def send(self, raw):
        self.process.stdin.write(raw if isinstance(raw, bytes) else raw.encode())
        self.process.stdin.write(b"\n")
        self.process.stdin.flush()

    def receive(self, seconds=120):
        line = self.lines.get(timeout=seconds)
        if line is None:
            raise EOFError(self.process.stderr.read())
        message = json.loads(line)
        return message

    def notify(self, method, parameters=None):
        self.send(json.dumps({"jsonrpc": "2.0", "method": method, **({"params": parameters} if parameters else {})}))

    def start(self, method, parameters=None, id=None):
        self.number += 1
        id = self.number if id is None else id
        self.send(json.dumps({"jsonrpc": "2.0", "id": id, "method": method, **({"params": parameters} if parameters is not None else {})}))
        return id

    def answer_to(self, id, seconds=120):
        end = time.time() + seconds
        while True:
            message = self.receive(max(0.1, end - time.time()))
            if isinstance(message, dict) and message.get("id") == id and "method" not in message:
                return message
            self.notifications.append(message)

    def request(self, method, parameters=None, seconds=120):
        return self.answer_to(self.start(method, parameters), seconds)

    def call(self, tool, seconds=120, **arguments):
        """The structured answer of a tool."""
        message = self.request("tools/call", {"name": tool, "arguments": arguments}, seconds)
        self.transcript.append((tool, arguments, message))
        return message["result"]["structuredContent"]

    def close(self):
        self.process.stdin.close()
        status = self.process.wait(timeout=20)
        self.process.stdout.close(), self.process.stderr.close()
        return status
