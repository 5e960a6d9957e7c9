// SPDX-License-Identifier: MIT OR Apache-2.0
//
// The frame handshake of a design with one program a frame: resultants only, with up to three frames between it and the
// output, or, with FIELD, the paper's plan, whose two fields have a place until they have left. With JOINT the search is
// that of the joint estimator, whose search, features and correction have a frame each: up to five.
//
// The generated top level with its control logic. Left out, and free to do anything in any cycle: the skid buffers,
// Bz, CeAn, the arithmetic, and how long programs, search and summary take. The sink may stall for ever.
`include "progress.svh"

module harness (
    input wire clock
);

`ifdef FIELD
    localparam BEAT_BITS = 6;
    localparam [5:0] LAST_BEAT = 6'd51;
`else
    localparam BEAT_BITS = 4;
    localparam [3:0] LAST_BEAT = 4'd15;
`endif

    reg started = 1'b0;
    wire reset; // a cycle longer
    wire frame_ready;
    wire start;
    wire issued;
    wire sums_complete;
    wire sums_take;
    wire coefficients_complete;
    wire out_tready;
    wire search_over;
    wire issuing;
    wire scheduler_busy;
    wire [1:0] u_held;
    wire u_released;
    wire [1:0] u_waiting;
    wire searching;
    wire answer_waits;
    wire search_done;
    wire summary_busy;
    wire summary_there;
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
    wire search_start;
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
`ifdef FIELD
    wire field_complete;
    wire field_release;
    wire [1:0] fields_there;
    wire [2:0] frames_held;
`endif
    wire [BEAT_BITS-1:0] beat;
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
        .out_tready (out_tready),
        .answer_take (search_over),
        .u_released (u_released),
        .\spmv_array.issuing_now (issuing),
        .\scheduler.busy (scheduler_busy),
        .\scheduler.u_held (u_held),
        .\estimator.search_done (search_done),
        .\op.summary_busy (summary_busy),
        .\op.summary_there (summary_there),
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
        .\estimator.search_start (search_start),
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
`ifdef FIELD
        .field_complete (field_complete),
        .field_release (field_release),
        .\op.fields_there (fields_there),
        .\scheduler.frames_held (frames_held),
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

    // ---- Where the frames are: in the lanes, then with their last results on the way. A frame's program may begin
    // while the results of the one before come out
    reg arriving; // the last issue is over, the last result is not there
    reg summed; // the sums of the frame whose results come out are complete
    reg sums_wait; // and not taken
    reg summary_due;
    reg [3:0] recent; // sums were written in one of the last cycles
    reg [3:0] completed; // the last results came in one of the last cycles
    wire sums_written = $anyseq;
`ifdef FIELD
    reg at_output; // a frame whose field is still needed

    always @(posedge clock) begin
        at_output <= output_start || (at_output && !field_release);
        if (reset) begin
            at_output <= 1'b0;
        end
    end
`endif

    always @(posedge clock) begin
        started <= 1'b1;
        arriving <= issued || (arriving && !coefficients_complete);
        summed <= (summed || sums_written) && !coefficients_complete;
        sums_wait <= sums_written || (sums_wait && !sums_take);
        recent <= {recent[2:0], sums_written};
        completed <= {completed[2:0], coefficients_complete};
        summary_due <= search_over || (summary_due && !summary_done);
        if (reset) begin
            arriving <= 1'b0;
            summed <= 1'b0;
            sums_wait <= 1'b0;
            recent <= 4'd0;
            completed <= 4'd0;
            summary_due <= 1'b0;
        end
    end

    // What was left out answers when it was asked, once. The schedule sees to it that a program's results are complete
    // before the last issue of the next one, and that its sums come before them; a frame's sums do not come in the
    // first cycles after those of the frame before
    always @(*) begin
        if (!reset) begin
            assume (sums_complete == sums_wait);
`ifdef FIELD
            // A frame's field is there with its sums
            assume (field_complete == sums_written);
`endif
            assume (!sums_written || ((arriving || issuing) && !summed));
            assume (!sums_written || (recent == 4'd0));
            assume (!coefficients_complete || (arriving && summed));
            assume (!issued || !arriving);
            assume (!search_done || (answering && !answer_waits));
`ifdef JOINT
            // Sums stand in Co until the search takes them. By then the direction is there, and the next ones are not
            // written in the first cycles after the last results of their frame
            assume (direction_valid || (u_waiting == 2'd0));
            assume (!sums_written || (completed == 4'd0));
            assume (!level_done || (searching && !centroid_waits));
            assume (!features_done || (extracting && !centre_waits));
            assume (!window_done || showing);
`endif
            assume (!summary_done || summary_due);
        end
    end

    always @(posedge clock) begin
        if (!reset) begin
            // One program at a time
            assert (!start || !issuing);
            // Nothing is overwritten before it was used: sums, u, the summary, the frame at the output
            assert (!sums_written || !sums_wait);
            assert (!coefficients_complete || (u_there < 3'd2));
            assert (!search_over || !summary_busy);
            assert (!output_start || !(busy || beat_issued || valid[1] || valid[2]));
            // Places: two frames' u
            assert (!start || (u_held < 2'd2));
            assert (!u_released || (u_held != 2'd0));
`ifdef JOINT
            // A frame passes on when there is one, to a stage that has none; the bank that is filled is not searched
            assert (!search_start || !searching);
            assert (!features_start || (searching && !extracting && !showing));
            assert (!correction_start || (extracting && !showing && !correcting));
            assert (!(issuing || arriving) || !searching || (fill_bank != search_bank));
`endif
`ifdef FIELD
            // And two fields, which are never given back twice
            assert (frames_held <= 3'd2);
            assert (!start || (frames_held < 3'd2));
            assert (!field_release || (frames_held != 3'd0));
            assert (!output_start || !at_output);
`endif
        end
    end

`ifdef INVARIANTS
    always @(posedge clock) begin
        if (!reset) begin
            assert ({2'd0, u_held} == {3'd0, issuing} + arriving + u_there + searching);
            assert ((u_held <= 2'd2) && !(start && (u_held == 2'd2)));
            assert (!found_waits || searching);
            assert (!centre_waits || extracting);
            assert (!extracting || !showing);
`ifdef JOINT
            assert ({3'd0, sums_wait} == {3'd0, summed} + u_there);
            assert (!sums_take || sums_wait);
            // Banks are taken in turn, and the frame before is searched at once
            assert (fill_bank == (search_bank ^ searching ^ u_waiting[0]));
            assert (!(issuing || arriving) || (u_there == 3'd0) || searching || (completed != 4'd0));
`else
            assert ({3'd0, sums_stand} + (line_state != 3'd0) == {3'd0, summed} + u_there);
            assert (!sums_take || (sums_wait && (line_state != 3'd0)));
            assert (line_state <= 3'd4);
            // A line that is free takes sums at once
            assert (!sums_stand || (line_state != 3'd0) || searching || (recent != 4'd0));
            assert (!sums_take || searching || !issuing || summed || (recent != 4'd0));
`endif
            assert (!summed || issuing || arriving);
            assert (scheduler_busy == (start || issuing));
            // Op
            assert (!answer_waits || answering);
            assert (!summary_due || summary_busy);
            assert (summary_there == (summary_busy && !summary_due));
`ifdef FIELD
            assert ({1'b0, frames_held} == {2'd0, u_held} + summary_busy + at_output);
            assert ({2'd0, fields_there} == {3'd0, summed} + u_there + searching + summary_busy);
            assert (at_output == (busy || beat_issued || field_release));
            assert (!field_release || !(busy || beat_issued));
            assert (!busy || (beat <= LAST_BEAT));
`endif
            // The beats of a frame pass the output's stages without a gap, the last one marked
            assert (!beat_issued || (issued_last == !busy));
            assert (!valid[1] || (lasts[1] == !beat_issued));
            assert (!valid[2] || (lasts[2] == !valid[1]));
            assert (beat_issued || !busy || !(valid[1] || valid[2]));
            assert (valid[1] || !(busy || beat_issued) || !valid[2]);
        end
    end
`endif

    // ---- Progress: what is left to do for the frames inside
    wire [9:0] left_in_lanes = (start ? 10'd136 : 10'd0) + (issuing ? 10'd133 : 10'd0) + (arriving ? 10'd128 : 10'd0)
        - {9'd0, summed};
    wire [9:0] left_of_search = 10'd116 * u_there + (searching ? (found_waits ? 10'd109 : 10'd112) : 10'd0)
        + (extracting ? (centre_waits ? 10'd102 : 10'd105) : 10'd0) + (showing ? 10'd5 : 10'd0)
        + (correcting ? (answer_waits ? 10'd83 : 10'd88) : 10'd0)
        + (summary_due ? 10'd63 : summary_busy ? 10'd58 : 10'd0);
    wire [9:0] left_at_output = busy ? 10'd5 + LAST_BEAT - beat : beat_issued ? 10'd3 : valid[1] ? 10'd2
        : {9'd0, valid[2]};
    wire [9:0] left = left_in_lanes + left_of_search + left_at_output;
    wire asked = issuing || arriving || (searching && !found_waits) || (extracting && !centre_waits) || showing
        || (correcting && !answer_waits) || summary_due;
    wire answered = issued || sums_written || coefficients_complete || level_done || features_done || window_done
        || search_done || summary_done;
    wire line_willing = (u_waiting == 2'd0) || searching || line_valid;

    progress progress (
        .clock (clock),
        .reset (reset),
        .frame_ready (frame_ready),
        .start (start),
        .willing (out_tready && line_willing && (answered || !asked)),
        .left (left)
    );

endmodule
