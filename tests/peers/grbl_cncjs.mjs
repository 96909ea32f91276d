// Drives a simulated Grbl controller by CNCjs' server, without its window (tests/peers/README.md).
//
//   node grbl_cncjs.mjs GRBL_PEER [FOLDER]
//
// GRBL_PEER: the program of grbl_peer.cc. FOLDER: where `npm install cncjs` was run; default: $FLEXURA_CNCJS. Exit
// status 0: the controller has executed all lines of a program and is at its end, or there is no FOLDER.
import {spawn} from 'node:child_process';
import {mkdtempSync, rmSync} from 'node:fs';
import {createRequire} from 'node:module';
import {createServer} from 'node:net';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {createInterface} from 'node:readline';

const [peerProgram, modules = process.env.FLEXURA_CNCJS] = process.argv.slice(2);
if (!modules) {
  console.log('skipped: needs a folder with CNCjs');
  process.exit(0);
}
const require = createRequire(join(modules, 'node_modules/cncjs/package.json'));
const connect = require('socket.io-client');
const patience = 150000;  // ms

const children = [];
const scratch = mkdtempSync(join(tmpdir(), 'cncjs-'));
function end(status, message) {
  console.log(message);
  for (const child of children) child.kill();
  rmSync(scratch, {recursive: true, force: true});
  process.exit(status);
}
setTimeout(() => end(1, 'failed: no end in time'), patience);

const freePort = () => new Promise((resolve) => {
  const server = createServer();
  server.listen(0, '127.0.0.1', () => {
    const {port} = server.address();
    server.close(() => resolve(port));
  });
});
// Resolves with the first arguments of an event that pass.
const once = (socket, event, passes = () => true) => new Promise((resolve) => {
  const listener = (...values) => {
    if (!passes(...values)) return;
    socket.removeListener(event, listener);
    resolve(values);
  };
  socket.on(event, listener);
});
const check = (condition, message) => { if (!condition) end(1, `failed: ${message}`); };

const peer = spawn(peerProgram, ['120'], {stdio: ['pipe', 'pipe', 'inherit']});
children.push(peer);
const lines = createInterface({input: peer.stdout})[Symbol.asyncIterator]();
const path = (await lines.next()).value;

const port = await freePort();
const server = spawn(process.execPath, [join(modules, 'node_modules/cncjs/bin/cncjs'), '--port', String(port),
                                        '--host', '127.0.0.1', '--config', join(scratch, 'cncrc')],
                     {env: {...process.env, HOME: scratch, NODE_ENV: 'production'}, stdio: 'ignore'});
children.push(server);
let token;
while (token === undefined) {
  try {
    const answer = await fetch(`http://127.0.0.1:${port}/api/signin`, {method: 'POST'});
    token = (await answer.json()).token;
  } catch {
    await new Promise((resolve) => setTimeout(resolve, 200));
  }
}
const socket = connect(`http://127.0.0.1:${port}`, {query: `token=${token}`});
const heard = [];
socket.on('serialport:read', (line) => heard.push(line));
await once(socket, 'startup');
const started = once(socket, 'controller:settings', (type, settings) => Object.keys(settings.settings).length > 20);
socket.emit('open', path, {controllerType: 'Grbl', baudrate: 115200});
const [, settings] = await started;
check(settings.settings.$100 === '100.000', `$100 is ${settings.settings.$100}`);

// 300 short lines: more than the controller's queue and receive buffer take at once.
const program = ['G21', 'G90', 'G1 F6000'];
for (let i = 1; i <= 300; ++i) program.push(`G1 X${(i / 10).toFixed(3)} Y${(i % 2 / 5).toFixed(3)} Z${(-i / 20).toFixed(3)}`);
const finished = once(socket, 'sender:status', (status) => status.finishTime > 0);
socket.emit('command', path, 'gcode:load', 'zigzag.nc', program.join('\n'), {}, () => {});
await once(socket, 'gcode:load');
socket.emit('command', path, 'gcode:start');
const [sent] = await finished;
check(sent.received === sent.total, `${sent.received} of ${sent.total} lines answered`);

const isAt = (x, y, z) => once(socket, 'controller:state', (type, state) => {
  const at = state.status.mpos;
  return state.status.activeState === 'Idle' && Number(at.x) === x && Number(at.y) === y && Number(at.z) === z;
});
await isAt(30, 0, -15);
// Hold, resume, jog, and a reset at rest.
socket.emit('command', path, 'gcode', 'G1 X0 F3000');
await once(socket, 'controller:state', (type, state) => state.status.activeState === 'Run');
socket.emit('command', path, 'feedhold');
await once(socket, 'controller:state', (type, state) => state.status.activeState === 'Hold');
socket.emit('command', path, 'cyclestart');
await isAt(0, 0, -15);
socket.emit('command', path, 'gcode', '$J=G90 G21 Z-1.25 F3000');
await isAt(0, 0, -1.25);
const greeted = once(socket, 'serialport:read', (line) => line.startsWith('Grbl 1.1h'));
socket.emit('command', path, 'reset');
await greeted;
check(!heard.some((line) => /error:|ALARM:/.test(line)), `heard ${heard.filter((line) => /error|ALARM/.test(line))}`);

peer.stdin.end();
const motors = (await lines.next()).value, lost = (await lines.next()).value;
check(motors === 'motors 0 0 -125', motors);
check(lost === 'lost 0', lost);
end(0, `passed: CNCjs sent ${sent.total} lines; ${motors}; ${lost}`);
