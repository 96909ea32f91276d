// Message over the 3D view while the program is unreachable or refuses access.
import { useEffect, useState } from 'preact/hooks';
import { use_app } from './app';

export function Entrance() {
  const { viewer } = use_app();
  const status = viewer.link.status.value;
  if (status.kind === 'open') return null;
  if (status.kind === 'refused') return <Refused why={status.why} />;
  if (status.kind === 'waiting') return <Waiting why={status.why} at={status.at} />;
  // The first connection is quick and needs no message; a lost one shows it while reconnecting.
  return viewer.hello.value ? <div class="entrance" role="status">Connecting again …</div> : null;
}

function Waiting({ why, at }: { why: string; at: number }) {
  const { viewer } = use_app();
  const [, count] = useState(0);
  useEffect(() => {
    const timer = setInterval(() => count((n) => n + 1), 250);
    return () => clearInterval(timer);
  }, []);
  const seconds = Math.max(0, Math.ceil((at - performance.now()) / 1000));
  return (
    <div class="entrance" role="status">
      <b>{why}</b>
      <span aria-live="off">{seconds ? `Trying again in ${seconds} s.` : 'Trying again.'}</span>
      <button type="button" class="button" title="Connects now" onClick={() => void viewer.link.open()}>Try now</button>
    </div>
  );
}

function Refused({ why }: { why: string }) {
  const app = use_app();
  const [text, set_text] = useState('');
  const [bad, set_bad] = useState(false);
  return (
    <form class="entrance" role="alertdialog" aria-label="Access refused" onSubmit={(event) => {
      event.preventDefault();
      set_bad(!app.use_token(text));
    }}>
      <b>{why}</b>
      <label for="token">Open the address that <code>flexura view</code> printed when it started, or paste it here:</label>
      <span class="row">
        <input id="token" type="text" title="The address or its token" autocomplete="off" spellcheck={false} value={text}
          placeholder="http://127.0.0.1:8421/#token=…" onInput={(event) => set_text(event.currentTarget.value)} />
        <button type="submit" class="button primary" title="Connects with this address or token">Connect</button>
      </span>
      {bad && <span class="bad">This text contains no token: expected 32 hexadecimal digits after “#token=”.</span>}
    </form>
  );
}
