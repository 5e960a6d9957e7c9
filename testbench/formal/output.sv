// SPDX-License-Identifier: MIT OR Apache-2.0
//
// Output stage: each word that leaves is that of its frame and of its place, however the sink stalls.
//
// Frames carry two contents in turn, both chosen freely. The harness counts frames and beats that leave. Values are 22
// bits wide, as the model of the converter keeps them. Of a field word it checks the exponent and that it is blank.
module harness (
    input wire clock,
    input wire start_wanted,
    input wire [63:0] field_value,
    input wire m_tready
);

    localparam [4:0] LAST = 5'd27;
    localparam FRAME = 340;
    localparam signed [9:0] FORCE_LSB = -10'sd50;
    localparam signed [9:0] TORQUE_LSB = -10'sd55;
    localparam signed [9:0] FIELD_LSB = -10'sd50;

    (* anyconst *) reg [FRAME-1:0] even;
    (* anyconst *) reg [FRAME-1:0] odd;
    reg started = 1'b0;
    wire reset = !started;
    wire idle;
    wire start = start_wanted && idle && started;

    // ---- Frames: taken in, and leaving
    reg [1:0] frames;
    reg loads; // the cycle after a start, in which the contents hold
    reg [1:0] leaving;
    reg [4:0] place;
    wire [1:0] holding = frames - 2'd1;
    wire content_is_odd = loads ? holding[0] : frames[0];
    wire [15:0] status;
    wire [31:0] timestamp;
    wire [31:0] counters;
    wire [4:0] exponent;
    wire blank;
    wire [21:0] force_x;
    wire [21:0] force_y;
    wire [21:0] force_z;
    wire [21:0] torque_x;
    wire [21:0] torque_y;
    wire [21:0] torque_z;
    wire [21:0] friction_quotient;
    wire [9:0] friction_exponent;
    wire [21:0] angle;
    wire [21:0] error_value;
    wire [9:0] error_exponent;
    wire [17:0] mu_x;
    wire [17:0] mu_y;
    assign {mu_x, mu_y, friction_exponent, error_exponent, force_x, force_y, force_z, torque_x, torque_y, torque_z,
        friction_quotient, angle, error_value, blank, exponent, counters, timestamp, status}
        = content_is_odd ? odd : even;

    wire [31:0] m_tdata;
    wire m_tlast;
    wire m_tvalid;
    wire busy;
    wire load;
    wire [15:0] frame_count;
    wire [4:0] beat;
    wire issued;
    wire issued_last;
    wire [4:0] issued_beat;
    wire [11:1] valid;
    wire [11:1] lasts;
    wire [3:1] blanks;
    wire [3:1] in_field;
    wire [3:0] beat_1;
    wire [3:0] beat_2;
    wire [15:0] frame_1;
    wire [15:0] frame_2;
    wire [15:0] held_status;
    wire [31:0] held_timestamp;
    wire [31:0] held_counters;
    wire [4:0] held_scale;
    wire held_blank;
    wire [63:0] held_force_x;
    wire [63:0] held_force_y;
    wire [63:0] held_force_z;
    wire [63:0] held_torque_x;
    wire [63:0] held_torque_y;
    wire [63:0] held_torque_z;
    wire [63:0] held_quotient;
    wire [9:0] held_exponent;
    wire [31:0] held_angle;
    wire [63:0] held_error;
    wire [9:0] held_error_exponent;
    wire [17:0] held_mu_x;
    wire [17:0] held_mu_y;
    wire [3:0] word_3;
    wire [63:0] summary_3;
    wire [9:0] summary_exponent_3;
    wire [9:0] field_exponent_3;
    wire [63:0] value_4;
    wire [9:0] exponent_4;
    wire [11:4] raws;
    wire [32*7-1:0] raw_words;
    wire [32*7-1:0] stages;

    sptfra_output subject (
        .clock             (clock),
        .reset             (reset),
        .start             (start),
        .idle              (idle),
        .status            (status),
        .timestamp         (timestamp),
        .counters          (counters),
        .exponent          (exponent),
        .blank             (blank),
        .wrench            ({42'd0, torque_z, 42'd0, torque_y, 42'd0, torque_x, 42'd0, force_z, 42'd0, force_y,
            42'd0, force_x}),
        .friction_quotient ({42'd0, friction_quotient}),
        .friction_exponent (friction_exponent),
        .angle             ({10'd0, angle}),
        .error_value       ({42'd0, error_value}),
        .error_exponent    (error_exponent),
        .mu_x              (mu_x),
        .mu_y              (mu_y),
        .field_value       (field_value),
        .m_tdata           (m_tdata),
        .m_tlast           (m_tlast),
        .m_tvalid          (m_tvalid),
        .m_tready          (m_tready),
        // Inside
        .busy                (busy),
        .load                (load),
        .frame_count         (frame_count),
        .beat                (beat),
        .issued              (issued),
        .issued_last         (issued_last),
        .issued_beat         (issued_beat),
        .valid               (valid),
        .lasts               (lasts),
        .blanks              (blanks),
        .in_field            (in_field),
        .beat_1              (beat_1),
        .beat_2              (beat_2),
        .frame_1             (frame_1),
        .frame_2             (frame_2),
        .held_status         (held_status),
        .held_timestamp      (held_timestamp),
        .held_counters       (held_counters),
        .held_scale          (held_scale),
        .held_blank          (held_blank),
        .held_wrench         ({held_torque_z, held_torque_y, held_torque_x, held_force_z, held_force_y, held_force_x}),
        .held_quotient       (held_quotient),
        .held_exponent       (held_exponent),
        .held_angle          (held_angle),
        .held_error          (held_error),
        .held_error_exponent (held_error_exponent),
        .field_mu_x          (held_mu_x),
        .field_mu_y          (held_mu_y),
        .\gen_words[0].word_3 (word_3),
        .\gen_words[0].summary_3 (summary_3),
        .\gen_words[0].summary_exponent_3 (summary_exponent_3),
        .\gen_words[0].field_exponent_3 (field_exponent_3),
        .\gen_words[0].value_4 (value_4),
        .\gen_words[0].exponent_4 (exponent_4),
        .\gen_words[0].raws (raws),
        .\gen_words[0].raw_words (raw_words),
        .\gen_words[0].fixed_to_float.stages (stages)
    );

    always @(posedge clock) begin
        started <= 1'b1;
        loads <= start;
        frames <= frames + {1'd0, start};
        if (m_tvalid && m_tready) begin
            place <= m_tlast ? 5'd0 : place + 5'd1;
            leaving <= leaving + {1'd0, m_tlast};
        end
        if (reset) begin
            loads <= 1'b0;
            frames <= 2'd0;
            leaving <= 2'd0;
            place <= 5'd0;
        end
    end

    // ---- What a word must be: {exponent, value}, or the word itself if it is no float32
    function is_raw(input [4:0] at);
        is_raw = (at == 5'd0) || (at == 5'd1) || (at == 5'd13);
    endfunction

    function [31:0] expected(input [1:0] number, input [4:0] at);
        reg [FRAME-1:0] of;
        reg signed [9:0] scale;
        reg [31:0] float;
        begin
            of = number[0] ? odd : even;
            scale = $signed({5'd0, of[84:80]});
            case (at)
                5'd2: float = {FORCE_LSB - scale, of[262 +: 22]};
                5'd3: float = {FORCE_LSB - scale, of[240 +: 22]};
                5'd4: float = {FORCE_LSB - scale, of[218 +: 22]};
                5'd5: float = {TORQUE_LSB - scale, of[196 +: 22]};
                5'd6: float = {TORQUE_LSB - scale, of[174 +: 22]};
                5'd7: float = {TORQUE_LSB - scale, of[152 +: 22]};
                5'd8: float = {of[294 +: 10], of[130 +: 22]};
                5'd9: float = {-10'sd29, of[108 +: 22]};
                5'd10: float = {-10'sd16, {4{of[339]}}, of[322 +: 18]};
                5'd11: float = {-10'sd16, {4{of[321]}}, of[304 +: 18]};
                5'd12: float = {of[284 +: 10] + FORCE_LSB - scale, of[86 +: 22]};
                default: float = {FIELD_LSB - scale, 22'd0};
            endcase
            expected = (at == 5'd0) ? {14'd0, number, of[15:0]} : (at == 5'd1) ? of[47:16]
                : (at == 5'd13) ? of[79:48] : float;
        end
    endfunction

    // A word without an answer, and those behind the summary's numbers, have the value 0 in any scale
    function is_zero(input [1:0] number, input [4:0] at);
        is_zero = !is_raw(at) && ((number[0] ? odd[85] : even[85]) || (at == 5'd14) || (at == 5'd15));
    endfunction

    function right(input [1:0] number, input [4:0] at, input [31:0] word);
        right = is_zero(number, at) ? (word[21:0] == 22'd0)
            : (at >= 5'd16) ? (word[31:22] == (expected(number, at) >> 22))
            : (at == 5'd0) ? (word[17:0] == (expected(number, at) & 32'h0003_ffff))
            : (word == expected(number, at));
    endfunction

    always @(*) begin
        if (started && m_tvalid) begin
            assert (m_tlast == (place == LAST));
            assert (right(leaving, place, m_tdata));
        end
    end

`ifdef INVARIANTS
    // ---- Frame and place of the beat in each stage: 0 is the one issued, 12 + 1 the next one to be issued
    wire [7*12-1:0] ats;
    wire [6:0] next;
    wire [6:0] at_0 = ats[7*0 +: 7];
    wire [6:0] at_1 = ats[7*1 +: 7];
    wire [6:0] at_2 = ats[7*2 +: 7];
    wire [6:0] at_3 = ats[7*3 +: 7];
    wire [6:0] at_4 = ats[7*4 +: 7];

    function [6:0] after(input [6:0] beat_there);
        after = (beat_there[4:0] == LAST) ? {beat_there[6:5] + 2'd1, 5'd0} : beat_there + 7'd1;
    endfunction

    genvar stage;
    assign ats[7*11 +: 7] = {leaving, place};
    for (stage = 1; stage < 12; stage = stage + 1) begin : gen_places
        assign ats[7*(stage-1) +: 7] = valid[stage] ? after(ats[7*stage +: 7]) : ats[7*stage +: 7];
    end
    assign next = issued ? after(at_0) : at_0;

    wire [FRAME-1:0] held = holding[0] ? odd : even;
    wire [FRAME-1:0] held_there = {held_mu_x, held_mu_y, held_exponent, held_error_exponent, held_force_x[21:0],
        held_force_y[21:0], held_force_z[21:0], held_torque_x[21:0], held_torque_y[21:0], held_torque_z[21:0],
        held_quotient[21:0], held_angle[21:0], held_error[21:0], held_blank, held_scale, held_counters, held_timestamp,
        held_status};
    wire needed = busy || issued || valid[1] || valid[2];

    always @(*) begin
        if (started) begin
            assert (next == {busy ? holding : frames, busy ? beat : 5'd0});
            assert (place <= LAST);
            assert (frame_count[1:0] == next[6:5]);
            assert (load == loads);
            assert (!load || (busy && (beat == 5'd0) && !issued && !valid[1] && !valid[2]));
            assert (!needed || (held_there[84:16] == held[84:16]));
            assert (!needed || load || (held_there == held));
            assert (!issued || (at_0 == {holding, issued_beat}));
            assert (!issued || (issued_last == (issued_beat == LAST)));
            assert (!valid[1] || (at_1[6:5] == holding));
            assert (!valid[2] || (at_2[6:5] == holding));
            assert (!valid[1] || (beat_1 == at_1[3:0]));
            assert (!valid[2] || (beat_2 == at_2[3:0]));
            assert (!valid[1] || (at_1[4:0] != 5'd0) || (frame_1[1:0] == at_1[6:5]));
            assert (!valid[2] || (at_2[4:0] != 5'd0) || (frame_2[1:0] == at_2[6:5]));
            // Stages 3 and 4
            assert (!valid[3] || (word_3 == at_3[3:0]));
            assert (!valid[3] || (at_3[4:0] > 5'd15) || (at_3[4:0] == 5'd14) || (at_3[4:0] == 5'd15)
                || (at_3[4:0] == 5'd0)
                || ((is_raw(at_3[4:0]) ? summary_3[31:0] : {summary_exponent_3, summary_3[21:0]})
                    == expected(at_3[6:5], at_3[4:0])));
            assert (!valid[3] || (at_3[4:0] != 5'd0)
                || (summary_3[17:0] == (expected(at_3[6:5], 5'd0) & 32'h0003_ffff)));
            assert (!valid[3] || (at_3[4:0] < 5'd14) || (at_3[4:0] > 5'd15) || (summary_3[21:0] == 22'd0));
            assert (!valid[3] || ({field_exponent_3, 22'd0} == expected(at_3[6:5], 5'd31)));
            assert (!valid[4] || right(at_4[6:5], at_4[4:0],
                raws[4] ? value_4[31:0] : {exponent_4, value_4[21:0]}));
        end
    end

    for (stage = 1; stage < 12; stage = stage + 1) begin : gen_stages
        wire [6:0] here = ats[7*stage +: 7];

        always @(*) begin
            if (started && valid[stage]) begin
                assert (lasts[stage] == (here[4:0] == LAST));
            end
        end
        if (stage < 4) begin : gen_choice
            always @(*) begin
                if (started && valid[stage]) begin
                    assert (in_field[stage] == (here[4:0] > 5'd15));
                    assert (blanks[stage] == (here[5] ? odd[85] : even[85]));
                end
            end
        end else begin : gen_raw
            always @(*) begin
                if (started && valid[stage]) begin
                    assert (raws[stage] == is_raw(here[4:0]));
                end
            end
        end
        if (stage > 4) begin : gen_word
            always @(*) begin
                if (started && valid[stage]) begin
                    assert (right(here[6:5], here[4:0],
                        raws[stage] ? raw_words[32*(stage-5) +: 32] : stages[32*(stage-5) +: 32]));
                end
            end
        end
    end
`endif

endmodule
