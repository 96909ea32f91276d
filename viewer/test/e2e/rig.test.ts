import { spatial_rig } from '../fake/rigs';
import { FakeServer } from '../fake/server';
import { dist } from './browser';
import { rig_tests } from './rig_tests';

let server: FakeServer | null = null;

rig_tests(async () => {
  server = new FakeServer(dist, spatial_rig());
  await server.start();
  return server;
}, () => server);
