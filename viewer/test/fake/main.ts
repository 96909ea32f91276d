// `npm run fake [planar|spatial] [live|recording]`: shows the page with the fake rig.
import { fileURLToPath } from 'node:url';
import { planar_rig, spatial_rig } from './rigs';
import { FakeServer } from './server';

const [kind = 'spatial', mode = 'live'] = process.argv.slice(2);
const folder = fileURLToPath(new URL('../../dist', import.meta.url));
const server = new FakeServer(folder, kind === 'planar' ? planar_rig() : spatial_rig(), mode as 'live' | 'recording');
await server.start(Number(process.env.PORT ?? 0));
console.log(server.url);
