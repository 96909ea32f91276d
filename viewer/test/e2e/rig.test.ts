import type { FakeServer } from '../fake/server';
import { faked } from './opened';
import { rig_tests } from './rig_tests';

let server: FakeServer | null = null;

rig_tests(async () => (server = await faked()), () => server);
