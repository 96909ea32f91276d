import type { FakeServer } from '../fake/server';
import { faked } from './opened';
import { program } from './program';
import { rig_tests } from './rig_tests';

let server: FakeServer | null = null;

// Fallback without the program.
rig_tests(async () => (server = await faked()), { page: true, server: !program }, () => server);
