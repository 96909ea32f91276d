// Drives the simulated ONVIF camera by the clients `onvif` and `node-onvif`: login, move, read back, stop.
//
//   node onvif_clients.mjs ONVIF_PEER
//
// ONVIF_PEER: the program of tests/peers/onvif_peer.cc.
import { spawn } from "node:child_process";
import { createInterface } from "node:readline";

const [peerProgram] = process.argv.slice(2);
let Cam, OnvifDevice;
try {
  ({ Cam } = (await import("onvif")).default);
  ({ OnvifDevice } = (await import("node-onvif")).default);
} catch {
  const isRequired = process.env.FLEXURA_REQUIRE_NODE !== undefined;
  console.log(`${isRequired ? "failed" : "skipped"}: needs \`npm ci\` in tests/node`);
  process.exit(isRequired ? 1 : 0);
}

const patience = 200000; // ms
const peer = spawn(peerProgram, ["190"], { stdio: ["pipe", "pipe", "inherit"] });
function end(status, message) {
  console.log(message);
  peer.kill();
  process.exit(status);
}
setTimeout(() => end(1, "failed: no end in time"), patience);
process.on("unhandledRejection", (error) => end(1, `failed: ${error.message}`));
const check = (condition, message) => {
  if (!condition) end(1, `failed: ${message}`);
};
const near = (value, wanted) => Math.abs(Number(value) - wanted) < 1e-3;
const lines = createInterface({ input: peer.stdout })[Symbol.asyncIterator]();
const port = Number((await lines.next()).value);

// The client `onvif`.
const login = { hostname: "127.0.0.1", port, username: "operator", password: "secret", timeout: 60000 };
const connected = (options) =>
  new Promise((resolve, reject) => {
    const cam = new Cam(options, (error) => (error ? reject(error) : resolve(cam)));
  });
const ask = (cam, name, ...values) =>
  new Promise((resolve, reject) => {
    cam[name](...values, (error, answer) => (error ? reject(error) : resolve(answer)));
  });
const cam = await connected(login);
check(cam.activeSource.profileToken === "profile_1", `profile ${cam.activeSource.profileToken}`);
const information = await ask(cam, "getDeviceInformation");
check(information.manufacturer === "Flexura", JSON.stringify(information));
const nodes = await ask(cam, "getNodes");
check(nodes.node_1 !== undefined, JSON.stringify(nodes));
await ask(cam, "absoluteMove", { x: 0.2, y: -0.1, zoom: 0.3 });
let status;
do {
  status = await ask(cam, "getStatus");
} while (status.moveStatus.panTilt === "MOVING");
check(near(status.position.x, 0.2) && near(status.position.y, -0.1) && near(status.position.zoom, 0.3),
  `onvif: at ${JSON.stringify(status.position)}`);
await ask(cam, "continuousMove", { x: -0.01, y: 0, zoom: 0 });
await ask(cam, "stop", { panTilt: true, zoom: true });
status = await ask(cam, "getStatus");
check(status.moveStatus.panTilt === "IDLE", `onvif: ${JSON.stringify(status.moveStatus)} after a stop`);
const refused = await connected({ ...login, password: "wrong" }).then(
  (other) => ask(other, "getStatus", { profileToken: "profile_1" }).then(() => "", (error) => error.message),
  (error) => error.message,
);
check(/authorized/i.test(refused), `onvif: a wrong password gives "${refused}"`);

// The client `node-onvif`.
const device = new OnvifDevice({
  xaddr: `http://127.0.0.1:${port}/onvif/device_service`, user: "operator", pass: "secret",
});
const found = await device.init();
check(found.Model === "Simulated camera", JSON.stringify(found));
const { ptz } = device.services;
const read = async () => (await ptz.getStatus({ ProfileToken: "profile_1" })).data.GetStatusResponse.PTZStatus;
await ptz.absoluteMove({ ProfileToken: "profile_1", Position: { x: -0.3, y: 0.4, z: 0.6 } });
let second;
do {
  second = await read();
} while (second.MoveStatus.PanTilt === "MOVING" || second.MoveStatus.Zoom === "MOVING");
const { PanTilt, Zoom } = second.Position;
check(near(PanTilt.$.x, -0.3) && near(PanTilt.$.y, 0.4) && near(Zoom.$.x, 0.6),
  `node-onvif: at ${JSON.stringify(second.Position)}`);
await device.ptzMove({ speed: { x: 0.01, y: 0, z: 0 }, timeout: 60 });
await device.ptzStop();
second = await read();
check(second.MoveStatus.PanTilt === "IDLE", `node-onvif: ${JSON.stringify(second.MoveStatus)} after a stop`);

peer.stdin.end();
const executed = (await lines.next()).value;
check(/^executed AbsoluteMove 2 ContinuousMove 2 Stop 2 /.test(executed), executed);
end(0, `passed: ${executed}`);
