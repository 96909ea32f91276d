// Setup of all browser test files.
import { afterAll } from 'vitest';
import { leave } from './opened';

afterAll(leave);
