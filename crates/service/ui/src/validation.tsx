import { useEffect, useState } from 'preact/hooks';
import { address, type Schemas } from './api';
import { number } from './figures';
import { Scroll } from './scroll';

/** The reference cases that are built into the program, flown now. */
export default function Validation({ onClose }: { onClose(): void }) {
  const [found, setFound] = useState<Schemas['Validation'] | string>('Flying the reference cases …');
  useEffect(() => {
    fetch(address('validation'))
      .then(async (response) => setFound(response.ok ? await response.json() : `The service answered ${response.status}.`))
      .catch(() => setFound('The service does not answer.'));
  }, []);
  return (
    <dialog
      class="validation"
      aria-label="Validation"
      ref={(dialog) => {
        if (dialog && !dialog.open) dialog.showModal();
      }}
      onClose={onClose}
    >
      <div class="panel-head">
        <h2>Validation</h2>
        <button type="button" onClick={onClose}>
          Close
        </button>
      </div>
      {typeof found === 'string' ? <p>{found}</p> : <Checks validation={found} />}
    </dialog>
  );
}

function Checks({ validation }: { validation: Schemas['Validation'] }) {
  return (
    <>
      <p>
        {validation.passed ? 'Every reference check passes.' : 'A reference check fails.'} A plausibility depends on more than was published
        of it.
      </p>
      <Scroll label="Table of checks">
        <table>
          <thead>
            <tr>
              {['Case', 'Quantity', 'Expected', 'Got', 'Difference', 'Allowed', 'Passed'].map((title) => (
                <th scope="col" key={title}>
                  {title}
                </th>
              ))}
            </tr>
          </thead>
          <tbody>
            {validation.checks.map((check) => (
              <tr key={`${check.case}${check.quantity}`} title={`${check.source}. ${check.note}`}>
                <th scope="row">{check.case}</th>
                <td>
                  {check.quantity}
                  {check.unit && `, ${check.unit}`}
                </td>
                {[check.expected, check.got, check.difference, check.allowed].map((value, index) => (
                  <td key={index}>{number(value ?? Number.NaN, index < 2 && check.expected !== 0 ? 8 : 3)}</td>
                ))}
                <td>{check.passed === null ? 'plausibility' : check.passed ? 'yes' : 'no'}</td>
              </tr>
            ))}
          </tbody>
        </table>
      </Scroll>
    </>
  );
}
