// Logs in to the simulated ONVIF camera by onvif-util of Debian's onvif-tools (tests/peers/README.md).
//
//   node onvif_util.mjs ONVIF_PEER MULTICAST_LOOP [ONVIF_UTIL]
//
// ONVIF_PEER: the program of onvif_peer.cc. MULTICAST_LOOP: the library of multicast_loop.cc. ONVIF_UTIL: default:
// onvif-util. Exit status 0: the tool found the camera, logged in, read its profile, and was refused with a wrong
// password; or there is no ONVIF_UTIL, or the machine has no multicast.
import { spawn, spawnSync } from "node:child_process";
import { createSocket } from "node:dgram";
import { createServer } from "node:net";
import { createInterface } from "node:readline";

const [peerProgram, loop, tool = "onvif-util"] = process.argv.slice(2);
const skip = (what) => {
  console.log(`skipped: needs ${what}`);
  process.exit(0);
};
if (spawnSync(tool, ["--help"], { timeout: 10000 }).error?.code === "ENOENT") skip("onvif-util of Debian's onvif-tools");

// Whether a multicast reaches a socket of this machine. Cameras are found in this way only.
const hasMulticast = () => new Promise((resolve) => {
  const socket = createSocket({ type: "udp4", reuseAddr: true });
  const end = (answer) => { clearTimeout(late); socket.close(); resolve(answer); };
  const late = setTimeout(() => end(false), 5000);
  socket.on("error", () => end(false));
  socket.on("message", () => end(true));
  socket.bind(0, () => {
    try {
      socket.addMembership("239.255.255.250");
      socket.setMulticastLoopback(true);
      socket.send("?", socket.address().port, "239.255.255.250");
    } catch { end(false); }
  });
});
if (!await hasMulticast()) skip("multicast");

const freePort = () => new Promise((resolve) => {
  const server = createServer();
  server.listen(0, "127.0.0.1", () => {
    const { port } = server.address();
    server.close(() => resolve(port));
  });
});
const port = await freePort();
const peer = spawn(peerProgram, ["150", String(port)], { stdio: ["pipe", "pipe", "inherit"] });
const lines = createInterface({ input: peer.stdout })[Symbol.asyncIterator]();
await lines.next();
const run = (password) => {
  const done = spawnSync(tool, ["-u", "operator", "-p", password, "127.0.0.1"], {
    input: "get time\nget profiles\nget rtsp\nquit\n", encoding: "utf8", timeout: 60000,
    env: { ...process.env, LD_PRELOAD: loop },
  });
  return done.stdout + done.stderr;
};
const good = run("secret"), bad = run("wrong");
peer.stdin.end();
const executed = (await lines.next()).value;
const wanted = [/serial: 0001/, /Time Offset: -?[01] seconds/, /Token 0: profile_1/,
  new RegExp(`rtsp://127.0.0.1:${port}/stream`)];
const missing = wanted.filter((one) => !one.test(good));
const isRefused = /NotAuthorized/.test(bad) && !/serial/.test(bad);
const passed = missing.length === 0 && isRefused;
console.log(`${passed ? "passed" : `failed: no ${missing} in\n${good}\nwrong password:\n${bad}`}: ${executed}`);
process.exit(passed ? 0 : 1);
