import { Button, Progress } from "@mantine/core";
import type { ReactNode } from "react";
import { deleteJobsByJobId, getJobs } from "../../api";
import { useQuery } from "../../rest/useQuery";
import { useAction } from "../../rest/useAction";
import { RejectionNote } from "../../rest/RejectionNote";
import { isOver, type Job } from "../../rest/useJob";
import { useTexts } from "../../texts/TextsContext";
import { Card } from "../parts/Card";
import { sentence } from "../parts/format";

const SHOWN = 5;

/** All jobs of the case: progress, result, and cancel button. */
export function Jobs(): ReactNode {
  const texts = useTexts();
  const cancelling = useAction();
  const { data, refetch } = useQuery((signal) => getJobs({ signal }), {
    everyMs: 1000,
  });
  const cancel = (job: Job): void => {
    void cancelling
      .run(async () => {
        await deleteJobsByJobId({ path: { job_id: job.id } });
      })
      .then(refetch);
  };
  if (data === null || data.jobs.length === 0) return null;
  return (
    <Card title={texts.case.jobsTitle} testId="jobs">
      <ul className="rows">
        {data.jobs.slice(0, SHOWN).map((job) => (
          <li key={job.id} className="row" data-state={job.state}>
            <div className="grow stack">
              <p>
                {sentence(job.title)} <span className="soft">{texts.case.jobStates[job.state]}</span>
                {!isOver(job) && job.doing !== "" && <span className="soft"> · {job.doing}</span>}
              </p>
              {!isOver(job) && <Progress size="lg" value={100 * job.progress_ratio} aria-label={job.title} />}
              {job.problem !== null && (
                <p className="soft">
                  {sentence(job.problem.message)} {job.problem.remedy}
                </p>
              )}
            </div>
            {!isOver(job) && (
              <Button
                size="lg"
                variant="default"
                disabled={job.state === "concluding"}
                onClick={() => {
                  cancel(job);
                }}
              >
                {texts.rest.cancel}
              </Button>
            )}
          </li>
        ))}
      </ul>
      <RejectionNote rejection={cancelling.rejection} />
    </Card>
  );
}
