// The frame handshake of the paper's plan: no frame overtakes another, none is overwritten, and each one ends.
//
// The generated top level with its control logic. Left out, and free to do anything in any cycle: the skid buffers,
// Bz, CeAn, the arithmetic, and how long lanes, search and summary take. The sink may stall for ever.
module harness (
    input wire clock
);

    localparam [5:0] LAST_BEAT = 6'd43;
    localparam [2:0] WAIT_U = 3'd0, WAIT_LINE = 3'd1, SEARCH = 3'd2, SUMMARY = 3'd3, WAIT_OUTPUT = 3'd4;

    reg started = 1'b0;
    wire reset = !started;
    wire frame_ready;
    wire frame_start;
    wire co_start;
    wire op_start;
    wire turn_issued;
    wire drained;
    wire sums_complete;
    wire field_release;
    wire out_tready;
    wire [2:0] phase;
    wire we_in_turn;
    wire co_in_turn;
    wire [1:0] frames_held;
    wire [2:0] state;
    wire line_valid;
    wire [2:0] line_state;
    wire search_done;
    wire summary_done;
    wire output_start;
    wire busy;
    wire [5:0] beat;
    wire issued;
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
        .frame_ready (frame_ready),
        .frame_start (frame_start),
        .co_start (co_start),
        .op_start (op_start),
        .turn_issued (turn_issued),
        .drained (drained),
        .sums_complete (sums_complete),
        .field_release (field_release),
        .out_tready (out_tready),
        .\spmv_array.phase_now (phase),
        .\we.in_turn (we_in_turn),
        .\co.in_turn (co_in_turn),
        .\co.frames_held (frames_held),
        .\op.state (state),
        .\op.line_valid (line_valid),
        .\op.line.state (line_state),
        .\op.search_done (search_done),
        .\op.summary_done (summary_done),
        .\op.output_start (output_start),
        .\op.frame_output.busy (busy),
        .\op.frame_output.beat (beat),
        .\op.frame_output.issued (issued),
        .\op.frame_output.issued_last (issued_last),
        .\op.frame_output.valid (valid),
        .\op.frame_output.lasts (lasts)
    );

    // ---- Where the frames are: in the lanes, in Op, at the output
    reg in_lanes;
    reg summed; // the sums of the frame in the lanes are complete
    reg at_output; // and its coefficients are still needed
    wire in_op = (state != WAIT_U);

    always @(posedge clock) begin
        started <= 1'b1;
        if (frame_start) begin
            in_lanes <= 1'b1;
            summed <= 1'b0;
        end
        if (drained) begin
            in_lanes <= 1'b0;
        end
        if (sums_complete) begin
            summed <= 1'b1;
        end
        if (output_start) begin
            at_output <= 1'b1;
        end else if (field_release) begin
            at_output <= 1'b0;
        end
        if (reset) begin
            in_lanes <= 1'b0;
            summed <= 1'b0;
            at_output <= 1'b0;
        end
    end

    // The sums come once a frame, in Co's turn or later, and before the frame's last result. The schedule sees to it
    // that the search and the summary of the frame before are over by then: Op is free, or waits for the output
    always @(*) begin
        if (!reset) begin
            assume (!sums_complete || (in_lanes && !summed && (phase >= 3'd3)));
            assume (!drained || summed);
            assume (!(sums_complete || drained) || !in_op || ((state == WAIT_OUTPUT) && !output_start));
        end
    end

    always @(posedge clock) begin
        if (!reset) begin
            // Op is free when a frame's last result comes, and the line when its sums come: no frame is lost
            assert (!drained || (state == WAIT_U));
            assert (!sums_complete || (line_state == 3'd0));
            // The field memory's two places are never taken a third time, and never given back twice
            assert (frames_held <= 2'd2);
            assert (!field_release || (frames_held != 2'd0));
            // One frame in the lanes, one at the output
            assert (!frame_start || !in_lanes);
            assert (!output_start || !at_output || field_release);
        end
    end

`ifdef INVARIANTS
    always @(posedge clock) begin
        if (!reset) begin
            assert ({2'd0, frames_held} == {3'd0, in_lanes} + in_op + at_output);
            assert (!frame_start || (frames_held != 2'd2));
            assert (in_lanes == (phase != 3'd0));
            assert (phase <= 3'd6);
            assert (we_in_turn == (phase == 3'd1));
            assert (co_start == (phase == 3'd2));
            assert (co_in_turn == (phase == 3'd3));
            assert (op_start == (phase == 3'd4));
            assert (!in_lanes || !summed || ((phase >= 3'd3) && !in_op));
            assert (state <= WAIT_OUTPUT);
            assert (line_state <= 3'd4);
            assert ((line_state != 3'd0) == ((in_lanes && summed) || in_op));
            assert ((state <= WAIT_LINE) || (line_state == 3'd4));
            // The beats of a frame pass the output's stages without a gap, the last one marked
            assert (at_output == (busy || issued || valid[1] || valid[2] || field_release));
            assert (!field_release || !(busy || issued || valid[1] || valid[2]));
            assert (!issued || (issued_last == !busy));
            assert (!valid[1] || (lasts[1] == !issued));
            assert (!valid[2] || (lasts[2] == !valid[1]));
            assert (issued || !busy || !(valid[1] || valid[2]));
            assert (valid[1] || !issued || !valid[2]);
            assert (!busy || (beat <= LAST_BEAT));
        end
    end
`endif

    // ---- Progress: what is left to do for the frames inside. It never grows but by a new frame, and shrinks in each
    // cycle in which those do something who may: so with a sink that is not for ever stalled, every frame ends
    wire [9:0] left_in_lanes = in_lanes ? 10'd340 + (3'd7 - phase) + !summed : 10'd0;
    wire [9:0] left_in_op = in_op ? 10'd330 + (3'd5 - state) : 10'd0;
    wire [9:0] left_at_output = busy ? 10'd5 + LAST_BEAT - beat : issued ? 10'd4 : valid[1] ? 10'd3 : valid[2] ? 10'd2
        : {9'd0, field_release};
    wire [9:0] left = left_in_lanes + left_in_op + left_at_output;
    wire lanes_willing = (phase == 3'd0) || (phase == 3'd2) || (phase == 3'd4) || turn_issued || drained
        || sums_complete;
    wire op_willing = (state == WAIT_LINE) ? line_valid : (state == SEARCH) ? search_done
        : (state == SUMMARY) ? summary_done : 1'b1;
    reg watched = 1'b0;
    reg willing;
    reg new_frame;
    reg [9:0] left_before;
    reg [3:1] waits = 3'd0; // a frame has waited for so many cycles
    reg [3:1] empty = 3'd0;

    always @(posedge clock) begin
        watched <= !reset;
        willing <= out_tready && lanes_willing && op_willing;
        new_frame <= frame_start;
        left_before <= left;
        waits <= {waits[2:1], frame_ready && !reset};
        empty <= {empty[2:1], (left == 10'd0) && !reset};
`ifdef INVARIANTS
        if (watched && !new_frame) begin
            assert (left <= left_before);
            assert (!willing || (left_before == 10'd0) || (left < left_before));
        end
        // A frame that waits is begun when nothing is in its way
        assert ((waits != 3'd7) || (empty != 3'd7) || (left != 10'd0));
`endif
    end

endmodule
