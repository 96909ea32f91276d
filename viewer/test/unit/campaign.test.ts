import { expect, test } from 'vitest';
import { campaign_state } from '../../src/panels/campaign';
import { duration_text } from '../../src/ui/format';
import type { CampaignMessage } from '../../src/protocol/types';

test.each([
  [0, '0 s'], [0.2, '1 s'], [59, '59 s'], [60, '1 min'], [61, '1 min 1 s'], [3600, '1 h'], [7199.5, '2 h'],
  [3725, '1 h 2 min'], [90000, '1 d 1 h'],
])('%d s is written as %s', (seconds, text) => {
  expect(duration_text(seconds)).toBe(text);
});

test('a campaign says how far it is', () => {
  const campaign: CampaignMessage = { type: 'campaign', runs: 5, total: 10, statuses: { done: 5 }, rate: null, left: null, reason: '', measures: [] };
  expect(campaign_state(campaign)).toBe('Not complete.');
  expect(campaign_state({ ...campaign, rate: 0 })).toBe('Not complete. No new runs finish.');
  expect(campaign_state({ ...campaign, rate: 0.1, left: 50 })).toBe('6 runs per minute, 50 s left.');
  expect(campaign_state({ ...campaign, rate: 12.345, left: 0.4 })).toBe('12.3 runs per second, 1 s left.');
  expect(campaign_state({ ...campaign, reason: 'all 10 runs are done' })).toBe('Complete: all 10 runs are done.');
  expect(campaign_state({ ...campaign, error: 'disk I/O error' })).toBe('The results cannot be read: disk I/O error.');
});
