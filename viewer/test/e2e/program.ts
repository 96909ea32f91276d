// Runs `flexura view` and `run` of the build whose program is named by FLEXURA_PROGRAM.
import { spawn, spawnSync, type ChildProcess } from 'node:child_process';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

export const program = process.env.FLEXURA_PROGRAM;

export class Program {
  /** The printed address. */
  url = '';
  /** Its working folder. */
  readonly folder = mkdtempSync(join(tmpdir(), 'flexura-e2e-'));
  private child: ChildProcess | null = null;

  /** Starts with an experiment file or a run's folder, or with complete arguments: `run x.toml --view`. */
  constructor(private readonly what: string | string[] = ['view']) {}

  get port(): number {
    return Number(new URL(this.url).port);
  }

  async start(port = 0): Promise<void> {
    const words = typeof this.what === 'string' ? ['view', this.what] : this.what;
    const child = spawn(program!, [...words, '--no-browser', '--port', String(port)], {
      cwd: this.folder, stdio: ['ignore', 'pipe', 'inherit'],
    });
    this.child = child;
    this.url = await new Promise<string>((resolve, reject) => {
      let said = '';
      child.stdout!.on('data', (bytes) => {
        said += String(bytes);
        const url = /viewer: (\S+)\n/.exec(said)?.[1];
        if (url) resolve(url);
      });
      child.on('error', reject);
      child.on('exit', () => reject(new Error(`${program} ended: ${said}`)));
    });
  }

  /** Runs an experiment with this expected exit status (1: unsafe). Returns the folder of its results. */
  record(file: string, status = 0): string {
    const results = join(this.folder, 'recorded');
    const ended = spawnSync(program!, ['run', file, '--out', results], { stdio: ['ignore', 'ignore', status ? 'ignore' : 'inherit'] });
    if (ended.status !== status) throw new Error(`run ended with ${ended.status}`);
    return results;
  }

  /** Renders a camera's picture of an experiment with other values at a time, s. Returns the file. */
  render(file: string, camera: string, time: number, values: string[] = []): string {
    const picture = join(this.folder, 'arm.png');
    const words = ['render', file, '--camera', camera, '--time', String(time), '--out', picture, ...values.flatMap((value) => ['--set', value])];
    const ended = spawnSync(program!, words, { stdio: ['ignore', 'ignore', 'inherit'] });
    if (ended.status !== 0) throw new Error(`render ended with ${ended.status}`);
    return picture;
  }

  async end(): Promise<void> {
    const { child } = this;
    if (!child || child.exitCode !== null) return;
    const over = new Promise((resolve) => child.once('exit', resolve));
    child.kill('SIGTERM');
    await over;
  }

  async stop(): Promise<void> {
    await this.end();
    rmSync(this.folder, { recursive: true, force: true });
  }
}
