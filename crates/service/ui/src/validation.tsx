import { useEffect, useState } from 'preact/hooks';
import { address, type Schemas } from './api';
import { number, withPlanetsInWords } from './figures';
import { Scroll } from './scroll';

/** The reference cases that are built into the program, flown now. */
export default function Validation({ onClose }: { onClose(): void }) {
  const [found, setFound] = useState<Schemas['Validation'] | string>('Running the reference cases …');
  useEffect(() => {
    fetch(address('validation'))
      .then(async (response) => setFound(response.ok ? await response.json() : `The service returned status ${response.status}.`))
      .catch(() => setFound('The service does not respond.'));
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
  const references = validation.checks.filter(({ passed }) => passed !== null);
  const failed = references.filter(({ passed }) => !passed).length;
  return (
    <>
      <p>
        {failed === 0 ? `All ${references.length} reference checks pass.` : `${failed} of ${references.length} reference checks fail.`}{' '}
        {validation.checks.length - references.length} comparisons with real flights, for information only.
      </p>
      <Scroll label="Checks">
        <table>
          <thead>
            <tr>
              {['Case', 'Quantity', 'Expected', 'Computed', 'Difference', 'Tolerance', 'Result'].map((title) => (
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
                  {withPlanetsInWords(check.quantity)}
                  {check.unit && `, ${check.unit}`}
                </td>
                {[check.expected, check.got, check.difference, check.allowed].map((value, index) => (
                  <td key={index}>{number(value ?? Number.NaN, index < 2 && check.expected !== 0 ? 8 : 3)}</td>
                ))}
                <td>{check.passed === null ? 'information' : check.passed ? 'pass' : 'fail'}</td>
              </tr>
            ))}
          </tbody>
        </table>
      </Scroll>
    </>
  );
}
