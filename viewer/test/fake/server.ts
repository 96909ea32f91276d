// A fake `flexura view` with the same requests and security policy, so that the page can be tested alone. It can also
// simulate faults that the program should never have.
import { randomBytes } from 'node:crypto';
import { createReadStream, existsSync } from 'node:fs';
import { createServer, type IncomingMessage, type Server, type ServerResponse } from 'node:http';
import { extname, join, normalize } from 'node:path';
import type { Duplex } from 'node:stream';
import { WebSocketServer, type WebSocket } from 'ws';
import { encode_image } from './encode';
import { answer, type Client } from './requests';
import type { RigDescription } from './rigs';
import { FakeSession } from './session';

const policy = "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; connect-src 'self'";
const types: Record<string, string> = {
  '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.svg': 'image/svg+xml', '.json': 'application/json',
};

interface Connected extends Client {
  socket: WebSocket;
  /** Numbers of unacknowledged pictures, by camera. */
  open_pictures: Map<string, number>;
  last_picture: Map<string, { time: number; seen: string }>;
}

export class FakeServer {
  session: FakeSession;
  /** Sends nothing, as after a network failure. */
  mute = false;
  /** Neither answers nor accepts connections, as after a silent network failure. */
  deaf = false;
  takes_sockets = true;
  /** Refuses all requests that move something, with this message. */
  refuse = '';
  /** Answers requests, but sends no new states. */
  stuck = false;
  /** Delay of replies to requests for times, ms. */
  delay_ms = 0;
  /** Delay of replies to requests for measurements, ms. */
  measure_delay_ms = 0;
  /** Pictures per second of an unchanged scene. Decoding and drawing them is the main cost of a page at rest. */
  resting_rate = 2;
  /** Largest number of such requests of a client that were unanswered at once. */
  most_outstanding = 0;
  token = randomBytes(16).toString('hex');
  port = 0;
  /** All received requests. */
  readonly log: Record<string, unknown>[] = [];
  private id = randomBytes(8).toString('hex');
  private http: Server | null = null;
  private clients = new Set<Connected>();
  private readonly swallowed = new Set<Duplex>();
  private timer: NodeJS.Timeout | undefined;
  private pictures = 0;
  private outstanding = 0;

  constructor(private readonly folder: string, private readonly rig: RigDescription, mode: 'live' | 'recording' = 'live') {
    this.session = new FakeSession(rig, mode);
  }

  get url(): string {
    return `http://127.0.0.1:${this.port}/#token=${this.token}`;
  }

  async start(port = this.port): Promise<void> {
    const http = createServer((request, response) => this.http_request(request, response));
    const sockets = new WebSocketServer({ noServer: true });
    http.on('upgrade', (request, socket, head) => {
      if (this.deaf || !this.takes_sockets) return void this.swallowed.add(socket);
      if (!this.may(request)) {
        socket.end('HTTP/1.1 401 Unauthorized\r\n\r\n');
        return;
      }
      sockets.handleUpgrade(request, socket, head, (ws) => this.welcome(ws));
    });
    await new Promise<void>((resolve) => http.listen(port, '127.0.0.1', resolve));
    this.http = http;
    this.port = (http.address() as { port: number }).port;
    this.timer = setInterval(() => this.beat(1 / 60), 1000 / 60);
  }

  async stop(): Promise<void> {
    clearInterval(this.timer);
    for (const { socket } of this.clients) socket.terminate();
    this.clients.clear();
    for (const socket of this.swallowed) socket.destroy();
    this.swallowed.clear();
    this.http?.closeAllConnections();
    await new Promise<void>((resolve) => (this.http ? this.http.close(() => resolve()) : resolve()));
  }

  /** Simulates a restart of the program: all state is new, including the token. */
  async restart(): Promise<void> {
    await this.stop();
    this.id = randomBytes(8).toString('hex');
    this.token = randomBytes(16).toString('hex');
    this.session = new FakeSession(this.rig, this.session.mode);
    await this.start();
  }

  get client_count(): number {
    return this.clients.size;
  }

  broadcast(message: Record<string, unknown>): void {
    for (const client of this.clients) client.send(JSON.stringify(message));
  }

  push_all(bytes: Buffer): void {
    for (const client of this.clients) client.push(bytes);
  }

  greet_all(): void {
    this.broadcast(this.session.hello(this.id));
  }

  private may(request: IncomingMessage): boolean {
    return request.headers.authorization === `Bearer ${this.token}`
      || (request.headers.cookie ?? '').includes(`=${this.token}`);
  }

  private http_request(request: IncomingMessage, response: ServerResponse): void {
    if (this.deaf) return;
    response.setHeader('Content-Security-Policy', policy);
    response.setHeader('Cache-Control', 'no-store');
    const { pathname, searchParams } = new URL(request.url ?? '/', 'http://x');
    const end = (status: number, body: string | Buffer = '', type = 'text/plain'): void => {
      response.writeHead(status, { 'Content-Type': type }).end(body);
    };
    const image = /^\/image\/(.+)\.png$/.exec(pathname);
    if (image || pathname === '/series' || pathname === '/report') {
      if (!this.may(request)) return end(401);
      if (request.headers.authorization === `Bearer ${this.token}`) {
        const port = /:(\d+)$/.exec(request.headers.host ?? '')?.[1] ?? '80';
        response.setHeader('Set-Cookie', `flexura_${port}=${this.token}; Path=/; HttpOnly; SameSite=Strict`);
      }
      if (pathname === '/report') return end(200, '<!doctype html><title>Report</title><p>The report.', 'text/html');
      if (!image) return this.series(searchParams, end);
      const camera = this.rig.scene.cameras.findIndex(({ name }) => name === decodeURIComponent(image[1]));
      if (camera < 0) return end(404);
      const pixels = this.session.pixels(camera, Number(searchParams.get('time') ?? this.session.time));
      return end(200, this.session.picture(camera, pixels), 'image/png');
    }
    const file = normalize(join(this.folder, pathname === '/' ? 'index.html' : pathname));
    if (!file.startsWith(normalize(this.folder)) || !existsSync(file)) return end(404);
    response.writeHead(200, { 'Content-Type': types[extname(file)] ?? 'application/octet-stream' });
    createReadStream(file).pipe(response);
  }

  private series(query: URLSearchParams, end: (status: number, body?: string, type?: string) => void): void {
    if (this.session.mode !== 'recording') return end(404);
    const names = (query.get('names') ?? '').split(',').filter(Boolean);
    end(200, JSON.stringify(this.session.series(names, Number(query.get('points') ?? 500))), 'application/json');
  }

  private welcome(socket: WebSocket): void {
    const client: Connected = {
      socket, time: 0, sent: new Map(), rates: new Map(), open_pictures: new Map(), last_picture: new Map(),
      send: (text) => !this.mute && socket.send(text),
      push: (bytes) => !this.mute && socket.bufferedAmount < 1e6 && socket.send(bytes),
    };
    this.clients.add(client);
    socket.on('close', () => this.clients.delete(client));
    socket.on('message', (data) => this.on_message(client, JSON.parse(String(data))));
    client.send(JSON.stringify(this.session.hello(this.id)));
  }

  private on_message(client: Connected, request: Record<string, unknown> & { do: string; id: number }): void {
    if (request.do === 'ack') return void client.open_pictures.delete(request.camera as string);
    this.log.push(request);
    let reply: Record<string, unknown>;
    try {
      if (this.refuse && request.do !== 'ping') throw new Error(this.refuse);
      reply = { result: answer(this, client, request) };
    } catch (error) {
      reply = { error: (error as Error).message };
    }
    const text = JSON.stringify({ type: 'reply', id: request.id, ...reply });
    if (request.do === 'measure' && this.measure_delay_ms) return void setTimeout(() => client.send(text), this.measure_delay_ms);
    if (request.do !== 'at' || !this.delay_ms) return client.send(text);
    this.most_outstanding = Math.max(this.most_outstanding, ++this.outstanding);
    setTimeout(() => {
      --this.outstanding;
      client.send(text);
    }, this.delay_ms);
  }

  private beat(dt: number): void {
    if (this.mute || this.stuck) return;
    const live = this.session.mode === 'live';
    if (live) this.session.step(dt);
    const state = live ? this.session.state() : null;
    for (const client of this.clients) {
      if (state) client.push(state);
      this.send_pictures(client, live ? this.session.time : client.time);
    }
  }

  private send_pictures(client: Connected, time: number): void {
    const seen = this.session.seen_now();
    this.rig.scene.cameras.forEach(({ name }, i) => {
      const last = client.last_picture.get(name);
      const rate = Math.min(last?.seen === seen ? this.resting_rate : 8, client.rates.get(name) ?? 0);
      if (!rate || client.open_pictures.has(name) || (last && Math.abs(time - last.time) < 1 / rate)) return;
      client.open_pictures.set(name, ++this.pictures);
      client.last_picture.set(name, { time, seen });
      const pixels = this.session.pixels(i, time);
      client.sent.set(name, { number: this.pictures, pixels, points: this.session.seen(i) });
      client.push(encode_image(i, this.pictures, time, this.session.picture(i, pixels)));
    });
  }
}
