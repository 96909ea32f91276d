import type { CampaignHistogram, CampaignMessage } from '../protocol/types';
import { use_app } from '../ui/app';
import { Icon } from '../ui/Icon';
import { campaign_state, number_text } from './campaign';

/** Progress of a campaign, and the distributions of its measures so far. */
export function CampaignPanel() {
  const { viewer } = use_app();
  const campaign = viewer.campaign.value;
  if (!campaign) return <p class="empty">No data received yet.</p>;
  return (
    <div class="campaign">
      <p class="campaign-state" role={campaign.error ? 'alert' : undefined}>{campaign_state(campaign)}</p>
      {!campaign.error && <Counts campaign={campaign} />}
      <p>
        <a class="button" href="report" target="_blank" rel="noopener"
          title="The report of the runs that are finished now, in a tab of its own: distributions, sensitivities and the worst runs">
          <Icon name="report" />Report of the campaign
        </a>
      </p>
      <p class="quiet">The view shows the rig of one run.</p>
      {campaign.measures.map((histogram) => <Histogram key={histogram.name} histogram={histogram} />)}
    </div>
  );
}

function Counts({ campaign: { runs, total, statuses, reason } }: { campaign: CampaignMessage }) {
  return (
    <>
      {/* A campaign may be complete before all runs. */}
      <progress max={Math.max(1, reason ? runs : total)} value={runs} aria-label="Progress of the campaign" />
      <table class="statuses">
        <tbody>
          <tr><th scope="row">Finished</th><td>{runs} of {total} runs</td></tr>
          {Object.entries(statuses).map(([status, count]) => (
            <tr key={status} data-status={status}>
              <th scope="row">{status}</th>
              <td>{count} ({number_text((100 * count) / runs)} %)</td>
            </tr>
          ))}
        </tbody>
      </table>
    </>
  );
}

function Histogram({ histogram: { name, low, high, bins } }: { histogram: CampaignHistogram }) {
  const most = Math.max(...bins);
  const runs = bins.reduce((sum, count) => sum + count, 0);
  return (
    <figure class="histogram">
      <figcaption>{name}</figcaption>
      <svg viewBox={`0 0 ${bins.length} 1`} preserveAspectRatio="none" role="img"
        aria-label={`Distribution of ${name} in ${runs} runs, from ${number_text(low)} to ${number_text(high)}`}>
        {bins.map((count, i) => <rect key={i} x={i + 0.05} width={0.9} y={1 - count / most} height={count / most} />)}
      </svg>
      <div class="ends"><span>{number_text(low)}</span>{high > low && <span>{number_text(high)}</span>}</div>
    </figure>
  );
}
