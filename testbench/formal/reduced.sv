// SPDX-License-Identifier: MIT OR Apache-2.0
//
// The frame handshake of the reduced plan: program scheduler, Op and output, with up to four frames between them.
//
// The generated top level with its control logic. Left out, and free to do anything in any cycle: the skid buffers,
// Bz, CeAn, the arithmetic, and how long programs, search and summary take. The sink may stall for ever. With JOINT the
// search is that of the joint estimator, which has no line before it, and stages of their own behind it: search, FEATURES and
// correction have a frame each. A frame's u are free for another when they were searched. With LATENCY frames wait for fields; with ONE_RESIDUAL only one has a place.
`include "progress.svh"

module harness (
    input wire clock
);

    localparam [5:0] LAST_BEAT = 6'd51;
`ifdef ONE_RESIDUAL
    localparam [1:0] RESIDUALS = 2'd1;
`else
    localparam [1:0] RESIDUALS = 2'd2;
`endif

    reg started = 1'b0;
    wire reset; // a cycle longer
    wire frame_ready;
    wire [2:0] start;
    wire issued;
    wire sums_complete;
    wire sums_take;
    wire coefficients_complete;
    wire field_complete;
    wire field_release;
    wire out_tready;
    wire friction_known;
    wire search_over;
    wire [2:0] issuing;
    wire scheduler_busy;
    wire residual_due;
    wire residual_written;
    wire [1:0] residuals_there;
    wire [1:0] fields_due;
    wire residual_bank;
    wire field_bank;
    wire [1:0] u_held;
    wire u_released;
    wire [2:0] frames_held;
    wire [1:0] fields_held;
    wire [1:0] u_waiting;
    wire searching;
    wire answer_waits;
    wire search_start;
    wire search_done;
    wire summary_busy;
    wire summary_there;
    wire [1:0] fields_there;
    wire field_there = fields_there[0];
    wire friction_done;
    wire summary_done;
    wire output_start;
`ifdef JOINT
    wire u_complete = 1'b0; // known at once
    wire line_valid = 1'b1;
    wire [2:0] line_state = 3'd0;
    wire direction_valid;
    wire level_done;
    wire centroid_waits;
    wire extracting;
    wire showing;
    wire centre_waits;
    wire features_done;
    wire window_done;
    wire correcting;
    wire features_start;
    wire correction_start;
    wire fill_bank;
    wire search_bank;
    wire found_waits = centroid_waits; // of what is searched
    wire answering = correcting; // what an answer is of
`else
    wire u_complete;
    wire line_valid;
    wire [2:0] line_state;
    wire level_done = 1'b0;
    wire extracting = 1'b0;
    wire showing = 1'b0;
    wire centre_waits = 1'b0;
    wire features_done = 1'b0;
    wire window_done = 1'b0;
    wire correcting = 1'b0;
    wire found_waits = answer_waits;
    wire answering = searching;
`endif
    wire busy;
    wire [5:0] beat;
    wire beat_issued;
    wire issued_last;
    wire [11:1] valid;
    wire [11:1] lasts;

    subject subject (
        .aclk          (clock),
        .aresetn       (started),
        .s_axis_tdata  (32'd0),
        .s_axis_tvalid (1'b0),
        .s_axis_tlast  (1'b0),
        .m_axis_tready (1'b0),
        // Inside
        .reset (reset),
        .frame_ready (frame_ready),
        .start (start),
        .issued (issued),
        .sums_complete (sums_complete),
        .sums_take (sums_take),
        .coefficients_complete (coefficients_complete),
        .field_complete (field_complete),
        .field_release (field_release),
        .out_tready (out_tready),
        .friction_known (friction_known),
        .answer_take (search_over),
        .u_released (u_released),
        .\spmv_array.issuing_now (issuing),
        .\scheduler.busy (scheduler_busy),
        .\scheduler.gen_field.residual_due (residual_due),
        .\scheduler.residual_written (residual_written),
        .\scheduler.gen_field.residuals_there (residuals_there),
        .\scheduler.gen_field.fields_due (fields_due),
        .residual_bank (residual_bank),
        .field_bank (field_bank),
        .\scheduler.u_held (u_held),
        .\scheduler.frames_held (frames_held),
        .\scheduler.gen_field.fields_held (fields_held),
        .\estimator.search_start (search_start),
        .\estimator.search_done (search_done),
        .\op.summary_busy (summary_busy),
        .\op.summary_there (summary_there),
        .\op.fields_there (fields_there),
        .\op.friction_done (friction_done),
        .\op.summary_done (summary_done),
        .\op.output_start (output_start),
`ifdef JOINT
        .direction_valid (direction_valid),
        .\estimator.level_done (level_done),
        .\estimator.centre_done (features_done),
        .\estimator.window_done (window_done),
        .\estimator.stages.u_waiting (u_waiting),
        .\estimator.stages.searching (searching),
        .\estimator.stages.centroid_waits (centroid_waits),
        .\estimator.stages.extracting (extracting),
        .\estimator.stages.showing (showing),
        .\estimator.stages.centre_waits (centre_waits),
        .\estimator.stages.correcting (correcting),
        .\estimator.stages.answer_waits (answer_waits),
        .\estimator.features_start (features_start),
        .\estimator.correction_start (correction_start),
        .\estimator.fill_bank (fill_bank),
        .\estimator.search_bank (search_bank),
`else
        .\estimator.fill_complete (u_complete),
        .\estimator.u_waiting (u_waiting),
        .\estimator.searching (searching),
        .\estimator.answer_waits (answer_waits),
        .\estimator.line_valid (line_valid),
        .\estimator.line.state (line_state),
`endif
        .\op.frame_output.busy (busy),
        .\op.frame_output.beat (beat),
        .\op.frame_output.issued (beat_issued),
        .\op.frame_output.issued_last (issued_last),
        .\op.frame_output.valid (valid),
        .\op.frame_output.lasts (lasts)
    );

    // Frames whose u is there, a register on its way counted; and sums whose taking has not been said yet
    wire [2:0] u_there = {1'b0, u_waiting} + {2'd0, u_complete};
    wire sums_stand = sums_wait && !sums_take;

    // ---- Where the frames are. A program is open from its start until its results are complete
    reg [2:0] open;
    reg [2:0] last; // the program started last
    reg [2:0] before; // and the one before
    reg summed; // the sums of program 0 are complete
    reg sums_wait; // and not taken
    reg friction_due;
    reg summary_due;
    reg field_started; // of the frame in the summary
    reg at_output; // a frame whose field is still needed
    reg [2:0] young; // program 0 began in one of the last cycles
    reg [3:0] recent; // sums were written in one of the last cycles
    wire sums_written = $anyseq;
    // Frames that wait for an answer
    wire [3:0] frames_due = {3'd0, open[0]} + u_there + searching + extracting + correcting;

    always @(posedge clock) begin
        started <= 1'b1;
        open <= (open & ~{field_complete, residual_written, coefficients_complete}) | start;
        if (start != 3'd0) begin
            before <= last;
            last <= start;
        end
        young <= {young[1:0], start[0]};
        recent <= {recent[2:0], sums_written};
        summed <= (summed || sums_written) && !coefficients_complete && !start[0];
        sums_wait <= sums_written || (sums_wait && !sums_take);
        friction_due <= search_over || (friction_due && !friction_done);
        summary_due <= search_over || (summary_due && !summary_done);
        field_started <= start[2] || (field_started && !output_start);
        at_output <= output_start || (at_output && !field_release);
        if (reset) begin
            open <= 3'd0;
            last <= 3'd0;
            before <= 3'd0;
            young <= 3'd0;
            recent <= 4'd0;
            summed <= 1'b0;
            sums_wait <= 1'b0;
            friction_due <= 1'b0;
            summary_due <= 1'b0;
            field_started <= 1'b0;
            at_output <= 1'b0;
        end
    end

    // What was left out answers when it was asked, once. The schedule sees to it that a program's results are complete
    // before the last issue of the program after it
    always @(*) begin
        if (!reset) begin
            assume (sums_complete == sums_wait);
            assume (!sums_written || (open[0] && !summed));
`ifdef JOINT
            // Sums stand in Co until the search takes them. By then the direction is there, and the next ones are not
            // written in the first cycles of their program
            assume (direction_valid || (u_waiting == 2'd0));
            assume (!sums_written || (young == 3'd0));
            assume (!level_done || (searching && !centroid_waits));
            assume (!features_done || (extracting && !centre_waits));
            assume (!window_done || showing);
`endif
            // The next ones are not written in the first cycles after those of the frame before
            assume (!sums_written || (recent == 4'd0));
            assume (!coefficients_complete || (open[0] && summed));
            assume (!residual_written || open[1]);
            assume (!field_complete || open[2]);
            assume (!issued || ((open & ~issuing) == 3'd0));
            assume (!search_done || (answering && !answer_waits));
            assume (!friction_done || friction_due);
            assume (!summary_done || (summary_due && !friction_due));
        end
    end

    always @(posedge clock) begin
        if (!reset) begin
            // One program at a time, and none while one of its kind is open
            assert ((start & (start - 3'd1)) == 3'd0);
            assert ((start == 3'd0) || (issuing == 3'd0));
            assert ((start & open) == 3'd0);
            // Nothing is overwritten before it was used: sums, u, residual, friction, field
            assert (!sums_written || !sums_wait);
            assert (!coefficients_complete || (u_there < 3'd2));
            assert (!residual_written || (residuals_there < RESIDUALS));
`ifndef ONE_RESIDUAL
            // A residual is not written where one is read, or waits to be read
            assert (!open[1] || !(issuing[2] || start[2]) || (residual_bank != field_bank));
            assert (!open[1] || (residuals_there == 2'd0) || (residual_bank == field_bank));
`endif
            assert (!friction_done || !friction_known);
            assert (!field_complete || !field_there);
            // A field has the friction of its own frame
            assert (!start[2] || (friction_known && summary_busy));
`ifdef LATENCY
            // No frame goes ahead of a field
            assert (!start[0] || (fields_due == 2'd0));
`endif
            // Places: two frames' u, two fields, four frames' weights, one output
            assert (!start[0] || (u_held < 2'd2));
            assert (!u_released || (u_held != 2'd0));
            assert (!field_release || ((fields_held != 2'd0) && (frames_held != 3'd0)));
            assert ((fields_held <= 2'd2) && (frames_held <= 3'd4));
            assert (!output_start || !at_output);
`ifdef JOINT
            // A frame passes on when there is one, to a stage that has none
`ifdef FEATURES
            assert (!features_start || (searching && !extracting && !showing));
            assert (!correction_start || (extracting && !showing && !correcting));
`else
            assert (!correction_start || (searching && !correcting));
`endif
            assert (!search_start || !searching);
            // The bank that is filled is neither searched nor read for features, and those two are not the same one
            assert (!open[0] || (u_there + searching < 3'd2));
            assert (!open[0] || !searching || (fill_bank != search_bank));
`endif
        end
    end

`ifdef INVARIANTS
    always @(posedge clock) begin
        if (!reset) begin
            assert ({2'd0, u_held} == {3'd0, open[0]} + u_there + searching);
            assert ((u_held <= 2'd2) && !(start[0] && (u_held == 2'd2)));
            assert ({1'b0, frames_held} == frames_due + summary_busy + at_output);
            assert ({2'd0, fields_held} == {3'd0, field_started} + at_output);
            assert ({3'd0, residual_due} + fields_due + start[2]
                == frames_due + (summary_busy && !field_started) + start[0]);
`ifdef JOINT
            assert ({3'd0, sums_wait} == {3'd0, open[0] && summed} + u_there);
            assert (!sums_take || sums_wait);
            // Banks are taken in turn
            assert (fill_bank == (search_bank ^ searching ^ u_waiting[0]));
            // The frame before is searched at once
            assert (!open[0] || (u_there == 3'd0) || searching || (young != 3'd0));
`else
            assert ({3'd0, sums_stand} + (line_state != 3'd0) == {3'd0, open[0] && summed} + u_there);
            assert (!sums_take || (sums_wait && (line_state != 3'd0)));
            // A line that is free takes sums at once
            assert (!sums_stand || (line_state != 3'd0) || searching || (recent != 4'd0));
            assert (!sums_take || searching || !open[0] || summed || (recent != 4'd0));
`endif
            assert (line_state <= 3'd4);
            assert (!summed || open[0]);
            // The lanes
            assert (scheduler_busy == ((start != 3'd0) || (issuing != 3'd0)));
            assert ((issuing == 3'd0) || (issuing == last));
            assert ((last & (last - 3'd1)) == 3'd0);
            assert ((open & ~(last | ((issuing != 3'd0) ? before : 3'd0))) == 3'd0);
            assert (!(last[0] && (start == 3'd0)) || residual_due);
            assert (!(last[1] && (start == 3'd0)) || ((fields_due != 2'd0) && !residual_due));
            assert (!start[0] || residual_due);
            assert (!start[1] || ((fields_due != 2'd0) && !residual_due));
            assert (!(issuing[2] || start[2]) || (fields_due < RESIDUALS));
            assert ({1'b0, residuals_there} + (open[1] || start[1]) == {1'b0, fields_due});
            assert (fields_due <= RESIDUALS);
`ifndef ONE_RESIDUAL
            assert ((residual_bank ^ field_bank) == fields_due[0]);
`endif
            // Op
            assert (!answer_waits || answering);
            assert (!found_waits || searching);
            assert (!centre_waits || extracting);
            assert (!extracting || !showing);
`ifndef FEATURES
            assert (!extracting && !showing);
`endif
            assert (!friction_due || summary_due);
            assert (!summary_due || summary_busy);
            assert (summary_there == (summary_busy && !summary_due));
            assert (friction_known == (summary_busy && !friction_due && !field_started));
            assert (!field_started || (summary_busy && !friction_due));
            assert (!fields_there[1]); // here the lanes wait for the friction, and one place would do
            assert (!field_there || field_started);
            assert (open[2] == (field_started && !field_there));
            // The beats of a frame pass the output's stages without a gap, the last one marked
            assert (at_output == (busy || beat_issued || field_release));
            assert (!field_release || !(busy || beat_issued));
            assert (!beat_issued || (issued_last == !busy));
            assert (!valid[1] || (lasts[1] == !beat_issued));
            assert (!valid[2] || (lasts[2] == !valid[1]));
            assert (beat_issued || !busy || !(valid[1] || valid[2]));
            assert (valid[1] || !(busy || beat_issued) || !valid[2]);
            assert (!busy || (beat <= LAST_BEAT));
        end
    end
`endif

    // ---- Progress: what is left to do for the frames inside
    wire [9:0] left_of_scheduler = (residual_due ? 10'd30 : 10'd0)
        + 10'd20 * fields_due - 10'd5 * residuals_there
        + (start[2] ? 10'd14 : (start != 3'd0) ? 10'd4 : (issuing != 3'd0) ? 10'd2 : 10'd0)
        + (field_there ? 10'd5 : field_started ? 10'd10 : 10'd0);
    wire [9:0] left_of_search = (open[0] ? (summed ? 10'd125 : 10'd126) : 10'd0) + 10'd116 * u_there
        + (searching ? (found_waits ? 10'd109 : 10'd112) : 10'd0)
        + (extracting ? (centre_waits ? 10'd102 : 10'd105) : 10'd0) + (showing ? 10'd5 : 10'd0)
        + (correcting ? (answer_waits ? 10'd83 : 10'd88) : 10'd0)
        + (friction_due ? 10'd68 : summary_due ? 10'd63 : summary_busy ? 10'd58 : 10'd0);
    wire [9:0] left_at_output = busy ? 10'd5 + LAST_BEAT - beat : beat_issued ? 10'd3 : {9'd0, field_release};
    wire [9:0] left = left_of_scheduler + left_of_search + left_at_output;
    wire asked = (issuing != 3'd0) || (open != 3'd0) || (searching && !found_waits)
        || (extracting && !centre_waits) || showing || (correcting && !answer_waits) || summary_due;
    wire answered = issued || sums_written || coefficients_complete || residual_written || field_complete
        || level_done || features_done || window_done || search_done || friction_done || summary_done;
    wire line_willing = (u_waiting == 2'd0) || searching || line_valid;

    progress progress (
        .clock (clock),
        .reset (reset),
        .frame_ready (frame_ready),
        .start (start[0]),
        .willing (out_tready && line_willing && (answered || !asked)),
        .left (left)
    );

endmodule
